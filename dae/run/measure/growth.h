#pragma once
// The slope of a line through points by least squares, and the difference of the slopes of its
// halves, for growth exponents and observed orders.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace momenta {

/// Slope of points first ≤ i < last; O(last − first).
inline double fitted_slope(const std::vector<double>& x, const std::vector<double>& y,
                           std::size_t first, std::size_t last) {
  const auto n = static_cast<double>(last - first);
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = first; i < last; ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// A slope and the spread of slopes of parts.
struct SlopeAndSpread {
  double slope;       ///< slope of all points
  double half_range;  ///< half the spread of slopes: all points and both halves
};

/// Halves are the first `half` points and those from n − half on.
inline SlopeAndSpread fitted_slopes(const std::vector<double>& x, const std::vector<double>& y,
                                    std::size_t half) {
  const std::size_t n = x.size();
  const double whole = fitted_slope(x, y, 0, n), early = fitted_slope(x, y, 0, half),
               late = fitted_slope(x, y, n - half, n);
  return {whole, 0.5 * (std::max({whole, early, late}) - std::min({whole, early, late}))};
}

// The growth of a drift: the exponent of a power law for its running maximum.

/// A value that was not measured: null in JSON, an empty cell in CSV.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Drift below this is rounding of Φ or Φ̇ itself, and shows no growth law [m, m/s].
inline constexpr double rounding_level = 1e-13;

/// A fitted power law running_max(t) ~ t^exponent.
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

// The observed order of a method: how fast an error falls with the number of steps,
//
//   error ∝ steps^(−r),
//
// r by least squares of the logarithms over a ladder of steps or tolerances. With error control the
// number of steps stands for the inverse of their mean length.

/// An observed order.
struct ObservedOrder {
  double order = not_measured;       ///< r; NaN: fewer than three rungs
  double half_range = not_measured;  ///< half the spread of slopes: ladder and halves
  int rungs = 0;                     ///< rungs in the fit
};

/// The order from errors (1) of runs with ascending numbers of steps. The fit takes rungs with an
/// error below 0.1, up to the least: later ones are rounding. NaN errors are left out.
ObservedOrder observed_order(const std::vector<double>& steps, const std::vector<double>& errors);

}  // namespace momenta
