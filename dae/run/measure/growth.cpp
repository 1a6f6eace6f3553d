#include <momenta/dae/run/measure/growth.h>

#include <algorithm>
#include <cmath>

namespace momenta {

namespace {

constexpr double range = 20;  // fitted range [T/20, T]: the first 5 % of a run are its transient
constexpr double least_range = 4;
constexpr int points = 60;  // log-spaced in the range

}  // namespace

Growth fit_growth(const std::vector<double>& t, const std::vector<double>& drift, double rounding) {
  Growth growth;
  if (t.size() < 40 || !(t.back() > 0)) return growth;
  const auto above =
      std::find_if(drift.begin(), drift.end(), [&](double d) { return d > rounding; });
  if (above == drift.end()) return growth;
  const double first = t[static_cast<std::size_t>(above - drift.begin())];
  if (!(first * least_range <= t.back())) return growth;
  growth.to = t.back();
  growth.from = std::max(t.back() / range, first);
  std::vector<double> x, y;
  double running = 0;
  std::size_t sample = 0;
  for (int i = 0; i < points; ++i) {
    const double at =
        growth.from * std::pow(growth.to / growth.from, static_cast<double>(i) / (points - 1));
    for (; sample < t.size() && t[sample] <= at * (1 + 1e-12); ++sample)
      running = std::max(running, drift[sample]);
    if (!(running > 0) || !std::isfinite(running)) return growth;
    x.push_back(std::log(at));
    y.push_back(std::log(running));
  }
  const auto [whole, half_range] = fitted_slopes(x, y, x.size() / 2);
  growth.exponent = whole;
  growth.half_range = half_range;
  return growth;
}

ObservedOrder observed_order(const std::vector<double>& steps, const std::vector<double>& errors) {
  constexpr double converging = 0.1;
  constexpr std::size_t least_rungs = 3;
  std::size_t last = errors.size();
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i] > 0 && (last == errors.size() || errors[i] < errors[last])) last = i;
  ObservedOrder found;
  if (last == errors.size()) return found;
  std::vector<double> x, y;
  for (std::size_t i = 0; i <= last; ++i) {
    if (!(errors[i] > 0 && errors[i] < converging && steps[i] > 0)) continue;
    x.push_back(std::log(steps[i]));
    y.push_back(-std::log(errors[i]));
  }
  if (x.size() < least_rungs) return found;
  // With an odd number both halves have the middle.
  const auto [slope, half_range] = fitted_slopes(x, y, (x.size() + 1) / 2);
  if (!std::isfinite(slope)) return found;
  found.order = slope;
  found.half_range = half_range;
  found.rungs = static_cast<int>(x.size());
  return found;
}

}  // namespace momenta
