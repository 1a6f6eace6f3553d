#include <momenta/dae/measure/growth.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr double range =
    20;                     // the fit looks at [T/20, T]: the first 5 % of a run are its transient
constexpr int points = 60;  // log-spaced in that range

double slope(const std::vector<double>& x, const std::vector<double>& y, std::size_t first,
             std::size_t last) {
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

}  // namespace

Growth fit_growth(const std::vector<double>& t, const std::vector<double>& drift) {
  Growth growth;
  if (t.size() < 40 || !(t.back() > 0)) return growth;
  growth.to = t.back();
  growth.from = t.back() / range;
  std::vector<double> x, y;
  double running = 0;
  std::size_t sample = 0;
  for (int i = 0; i < points; ++i) {
    const double at = growth.from * std::pow(range, static_cast<double>(i) / (points - 1));
    for (; sample < t.size() && t[sample] <= at * (1 + 1e-12); ++sample)
      running = std::max(running, drift[sample]);
    if (!(running > 0) || !std::isfinite(running)) return growth;
    x.push_back(std::log(at));
    y.push_back(std::log(running));
  }
  const std::size_t n = x.size();
  const double whole = slope(x, y, 0, n), early = slope(x, y, 0, n / 2),
               late = slope(x, y, n / 2, n);
  growth.exponent = whole;
  growth.half_range = 0.5 * (std::max({whole, early, late}) - std::min({whole, early, late}));
  return growth;
}

}  // namespace momenta
