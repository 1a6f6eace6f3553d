#pragma once
// The growth of a drift: the exponent of a power law for its running maximum.

#include <limits>
#include <vector>

namespace momenta {

/// The value of what was not measured: null in JSON, an empty cell in CSV.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Drift below this is rounding of Φ or Φ̇ itself, and shows no growth law [m, m/s].
inline constexpr double rounding_level = 1e-13;

/// A fitted power law running_max(t) ~ t^exponent.
struct Growth {
  double exponent = not_measured;    ///< NaN: no power law
  double half_range = not_measured;  ///< half the spread of the slopes of sub-ranges
  double from = 0;                   ///< fitted range of t [s]
  double to = 0;                     ///< its end [s]

  /// Whether the slopes of sub-ranges are near enough to each other for a power of t.
  bool is_power() const { return !(half_range > 0.5); }
};

/// Fits running_max(t) ~ t^exponent over the last factor 20 in t, on logarithmically spaced times,
/// by least squares. The half-range is half the spread of the slopes of the two halves of that
/// range and of the whole. The fit begins where the running maximum rises above `rounding`.
/// Exponent and half-range are NaN when there are too few samples, or when the maximum is above
/// `rounding` for less than the last factor 4. `t` ascending [s]; `drift` ≥ 0; `rounding` > 0, in
/// the unit of the drift.
Growth fit_growth(const std::vector<double>& t, const std::vector<double>& drift, double rounding);

}  // namespace momenta
