#pragma once
// The growth of a drift: the exponent of a power law for its running maximum.

#include <limits>
#include <vector>

namespace momenta {

/// A value that was not measured: null in JSON, an empty cell in CSV.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Drift below this is rounding of Φ or Φ̇ itself, and shows no growth law [m, m/s].
inline constexpr double rounding_level = 1e-13;

struct Growth {
  double exponent = not_measured;    ///< NaN: no power law
  double half_range = not_measured;  ///< half the spread of slopes: range and halves
  double from = 0;                   ///< start of the fitted range of t [s]
  double to = 0;                     ///< end [s]

  /// Whether slopes agree well enough for a power of t.
  bool is_power() const { return !(half_range > 0.5); }
};

/// Fits running_max(t) ~ t^exponent over the last factor 20 in t, on logarithmically spaced times,
/// by least squares. The fit begins where the running maximum rises above `rounding`. Exponent and
/// half-range are NaN with too few samples, or when the maximum is above `rounding` for less than
/// the last factor 4. `t` ascending [s]; `drift` ≥ 0; `rounding` > 0, in the unit of the drift.
Growth fit_growth(const std::vector<double>& t, const std::vector<double>& drift, double rounding);

}  // namespace momenta
