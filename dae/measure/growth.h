#pragma once
// How a drift grows: the exponent of its running maximum.

#include <limits>
#include <vector>

namespace momenta {

/// Of what was not measured: null in JSON, an empty cell in CSV.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Drift below this is the rounding of Φ, or of Φ̇, itself: no growth law is read from it [m, m/s].
inline constexpr double rounding_level = 1e-13;

/// A fitted power law running_max(t) ~ t^exponent.
struct Growth {
  double exponent = not_measured;    ///< NaN: no power law
  double half_range = not_measured;  ///< half the spread of the slopes of sub-ranges
  double from = 0;                   ///< fitted range of t [s]
  double to = 0;                     ///< its end [s]
};

/// Fits running_max(t) ~ t^exponent over the last factor 20 in t, on logarithmically spaced times,
/// by least squares. The half-range is half the spread of the slopes of the two halves of that
/// range and of the whole. What has not risen above `rounding` has no law: the fit begins where the
/// maximum leaves it. All NaN when there are too few samples, or the maximum is above it for less
/// than the last factor 4. `t` ascending [s], `drift` ≥ 0, `rounding` of its unit > 0.
Growth fit_growth(const std::vector<double>& t, const std::vector<double>& drift, double rounding);

}  // namespace momenta
