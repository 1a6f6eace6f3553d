#include <momenta/dae/measure/fitted_slope.h>
#include <momenta/dae/measure/observed_order.h>

#include <cmath>

namespace momenta {

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
