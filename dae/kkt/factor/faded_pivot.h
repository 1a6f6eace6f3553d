#pragma once
// The inverse of a pivot that fades where it is lost in rounding, so that a row which says nothing
// about the motion asks for no impulse.

#include <algorithm>

namespace momenta {

/// Least pivot in (7) and (3), recentred, relative to its group's scale, before it fades.
inline constexpr double fade_evaluation = 1e-8;
/// The same in projections, which must remove the whole error.
inline constexpr double fade_projection = 1e-13;

/// `fade` where the heaviest joint of a loop is `apart` times as heavy as its lightest, whose
/// mobility is the row's scale: regular pivots of others lie lower by as much, so from 10⁴ on
/// fading starts lower, down to fade_projection, where rounding is.
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
