#pragma once
// The slope of a line through points by least squares, and the difference of the slopes of its
// halves, for growth exponents and observed orders.

#include <algorithm>
#include <cstddef>
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

}  // namespace momenta
