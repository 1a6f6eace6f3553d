#include <momenta/core/kernel/tree/tree.h>
#include <momenta/dae/mechanism/joint_places.h>

#include <algorithm>
#include <map>

namespace momenta {

std::vector<JointPlace> joint_places(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  std::vector<JointPlace> places;
  if (const auto& lagrangian = mechanism.scene().lagrangian)
    for (int i = 0; i < mechanism.nq(); ++i)
      places.push_back(
          {lagrangian->coordinates[static_cast<std::size_t>(i)].name, {i}, {i}, {}, {}, -1});
  std::map<std::string, std::size_t> index;
  std::vector<int> coordinate(tree.drives.size());  // by drive: the coordinate it prescribes
  for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
    const Tree::Body& b = tree.bodies[k];
    const auto [found, fresh] = index.try_emplace(b.joint, places.size());
    if (fresh) places.push_back({b.joint, {}, {}, {}, {}, -1});
    JointPlace& place = places[found->second];
    for (int i = 0; i < b.nq; ++i) place.q.push_back(b.q + i);
    for (int i = 0; i < b.nv; ++i) place.u.push_back(b.u + i);
    if (b.has_quaternion()) place.quaternions.push_back(b.q + b.nq - 4);
    if (b.drive >= 0) {
      place.drives.push_back(b.drive);
      coordinate[static_cast<std::size_t>(b.drive)] = b.coordinate;
    }
    place.body = static_cast<int>(k);
  }
  for (JointPlace& place : places)
    std::sort(place.drives.begin(), place.drives.end(), [&](int a, int b) {
      return coordinate[static_cast<std::size_t>(a)] < coordinate[static_cast<std::size_t>(b)];
    });
  return places;
}

}  // namespace momenta
