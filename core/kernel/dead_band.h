#pragma once
// Springs with a dead band: no force while the length l is between rest and rest + b, a linear
// spring on either side, corners rounded over w = b/20 to each side. With x = l − rest,
//
//   f = −k s(x),   s(x) = r(x − b) − r(−x),   V = k (R(x − b) + R(−x)),   R' = r
//   r(y) = 0, y <= −w;    (y + w)²/4w, |y| < w;    y, y >= w
//   R(y) = 0;             (y + w)³/12w;            y²/2 + w²/6
//
// f has a continuous slope; it is that of sharp corners where |x| and |x − b| are above w, and off
// by at most k w/4 elsewhere. b = 0: no band.

#include <momenta/core/scalar/dual.h>

namespace momenta {

/// r(y).
template <class S>
S rounded_ramp(double w, const S& y) {
  if (!(value_of(y) > -w)) return S(0.0);
  if (!(value_of(y) < w)) return y;
  const S z = y + S(w);
  return (0.25 / w) * (z * z);
}
/// R(y).
template <class S>
S rounded_ramp_energy(double w, const S& y) {
  if (!(value_of(y) > -w)) return S(0.0);
  if (!(value_of(y) < w)) return 0.5 * (y * y) + S(w * w / 6);
  const S z = y + S(w);
  return (1 / (12 * w)) * (z * z * z);
}

/// s(x), the stretch.
template <class S>
S stretched(double band, const S& x) {
  if (band == 0) return x;
  const double w = band / 20;
  return rounded_ramp(w, S(x - S(band))) - rounded_ramp(w, S(-x));
}
/// V/k.
template <class S>
S stretched_energy(double band, const S& x) {
  if (band == 0) return 0.5 * (x * x);
  const double w = band / 20;
  return rounded_ramp_energy(w, S(x - S(band))) + rounded_ramp_energy(w, S(-x));
}

}  // namespace momenta
