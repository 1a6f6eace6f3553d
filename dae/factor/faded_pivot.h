#pragma once
// The inverse of a pivot that fades where it is lost in rounding, so that a row which says nothing
// about the motion asks for no impulse.

#include <algorithm>

namespace momenta {

/// How weak a pivot may be, relative to its group's scale, before it fades: in (7) and (3),
/// recentred.
inline constexpr double fade_evaluation = 1e-8;
/// The same in projections, which must remove what is there.
inline constexpr double fade_projection = 1e-13;

/// Where the heaviest joint of a loop is `apart` times as heavy as its lightest. The scale of a row
/// is the mobility of the lightest, and regular pivots of others lie lower by as much: from 10⁴ on
/// fading starts lower too, down to that of projections, where rounding is.
inline double fade_beside(double fade, double apart) {
  constexpr double unnoticed = 1e4;
  return std::max(fade / std::max(1.0, apart / unnoticed), std::min(fade, fade_projection));
}

/// d³/(d⁴ + τ⁴), written so that no power under- or overflows; 0 for d ≤ 0.
inline double faded_inverse(double d, double tau) {
  if (!(d > 0)) return 0;
  const double ratio = tau / d, squared = ratio * ratio;
  return 1 / (d * (1 + squared * squared));
}

}  // namespace momenta
