#include <momenta/core/kernel/forced_bodies.h>
#include <momenta/core/kernel/relative_ways.h>

namespace momenta {

template <class Space>
std::vector<ForcedBody> forced_bodies(const Model<Space>& model) {
  std::vector<int> parents;
  for (const auto& b : model.bodies) parents.push_back(b.parent);
  RelativeWays ways(parents);
  const auto to_ground = [&](int body) { ways.up(body, -1); };
  const auto between = [&](int a, int b) {
    if constexpr (Space::dimension == 6) return ways.between(a, b);
    to_ground(a);
    to_ground(b);
  };
  const auto at_joints = [&](const auto& terms) {
    for (const auto& term : terms) between(term.body, parents[static_cast<std::size_t>(term.body)]);
  };
  for (const auto& spring : model.springs) between(spring.child, spring.parent);
  for (const auto& bushing : model.bushings) between(bushing.child, bushing.parent);
  for (const auto& spring : model.coordinate_springs) at_joints(spring.terms);
  for (const auto& wrench : model.wrenches) to_ground(wrench.body);
  for (const auto& signal : model.signals) {
    using Of = typename Model<Space>::Signal::Of;
    if (signal.of == Of::sum)
      at_joints(signal.terms);
    else if (signal.of == Of::distance)
      between(signal.ends.child, signal.ends.parent);
    else
      to_ground(signal.ends.child);
  }
  const std::vector<OnWay> found = ways.found();
  std::vector<ForcedBody> forced;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] != OnWay::moved) continue;
    const bool from_rest =
        parents[k] >= 0 && found[static_cast<std::size_t>(parents[k])] == OnWay::at_rest;
    forced.push_back({static_cast<int>(k), from_rest});
  }
  return forced;
}

template std::vector<ForcedBody> forced_bodies(const Model<Spatial>&);
template std::vector<ForcedBody> forced_bodies(const Model<Planar>&);

}  // namespace momenta
