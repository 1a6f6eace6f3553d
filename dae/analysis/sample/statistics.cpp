#include <momenta/dae/analysis/sample/statistics.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

double quantile_of(const std::vector<double>& sorted, double p) {
  const double h = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(h);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (h - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Summary summary_of(std::vector<double> x) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::erase_if(x, [](double value) { return !std::isfinite(value); });
  Summary s;
  s.count = x.size();
  s.mean = s.deviation = s.least = s.greatest = none;
  s.quantiles.fill(none);
  if (x.empty()) return s;
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  // Sums about the middle value keep a small spread about a large number.
  const double middle = x[x.size() / 2];
  double sum = 0, squares = 0;
  for (const double value : x) sum += value - middle;
  const double away = sum / n;
  for (const double value : x) squares += (value - middle - away) * (value - middle - away);
  s.mean = middle + away;
  if (x.size() > 1) s.deviation = std::sqrt(squares / (n - 1));
  s.least = x.front();
  s.greatest = x.back();
  for (std::size_t i = 0; i < told_quantiles.size(); ++i)
    s.quantiles[i] = quantile_of(x, told_quantiles[i]);
  return s;
}

}  // namespace momenta
