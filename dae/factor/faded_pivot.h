#pragma once
// The inverse of a pivot that fades where it is lost in rounding, so that a row which says nothing
// about the motion asks for no impulse.

namespace momenta {

/// How weak a pivot may be, relative to its group's scale, before it fades: in (7) and (3),
/// recentred.
inline constexpr double fade_evaluation = 1e-8;
/// The same in projections, which must remove what is there.
inline constexpr double fade_projection = 1e-13;

/// d³/(d⁴ + τ⁴), written so that no power under- or overflows; 0 for d ≤ 0.
inline double faded_inverse(double d, double tau) {
  if (!(d > 0)) return 0;
  const double ratio = tau / d, squared = ratio * ratio;
  return 1 / (d * (1 + squared * squared));
}

}  // namespace momenta
