#include "equations/random_loops.h"

#include "equations/dense_lagrangian.h"

namespace momenta::equations {

LoopSpec random_loop(RandomTree& random, const Scene& scene, LoopKind kind) {
  LoopSpec l;
  l.name = "loop" + std::to_string(scene.loops.size());
  l.kind = kind;
  const int bodies = static_cast<int>(scene.bodies.size());
  const int child = random.below(bodies);
  const int parent = (child + 1 + random.below(bodies)) % (bodies + 1);  // the last one: ground
  l.child = scene.bodies[static_cast<std::size_t>(child)].name;
  l.parent = parent == bodies ? "ground" : scene.bodies[static_cast<std::size_t>(parent)].name;
  l.origin_child = random.vector(0.6);
  l.origin_parent = random.vector(0.6);
  l.rotation = random.turn();
  l.axis = random.direction();
  if (kind == LoopKind::universal) {
    // At any angle but a small one to the axis.
    const Eigen::Vector3d across = l.axis.unitOrthogonal();
    l.axis2 = Eigen::AngleAxisd(random.uniform(-1, 1), across.cross(l.axis)) * across;
  }
  if (kind == LoopKind::planar && random.chance(0.7)) {
    const Eigen::Vector3d across = l.axis.unitOrthogonal();
    l.direction = Eigen::AngleAxisd(random.uniform(-1, 1), across.cross(l.axis)) * across;
  }
  if (kind == LoopKind::distance) l.length = random.uniform(0.8, 1.5);
  return l;
}

void drive_loop(RandomTree& random, Scene& scene, const LoopSpec& l, int coordinates, int origins) {
  const auto add = [&](int coordinate, const std::string& origin) {
    DriveSpec d = random.drive("", coordinate);
    d.loop = l.name;
    d.origin = origin;
    if (l.kind == LoopKind::distance && origin.empty()) {
      d.kind = "harmonic";
      d.offset = random.uniform(0.9, 1.3);
      d.amplitude = random.uniform(-0.4, 0.4);
      d.frequency = random.uniform(0.5, 3);
      d.phase = random.uniform(-3, 3);
    }
    scene.drives.push_back(d);
  };
  for (int i = 0; i < driven_coordinates_of(l.kind); ++i)
    if (l.kind == LoopKind::spherical ? coordinates != 0 : (coordinates >> i & 1) != 0) add(i, "");
  const std::array<const char*, 3> names{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i)
    if ((origins >> i & 1) != 0) add(0, names[i]);
}

std::optional<LoopSpec> random_coupler(RandomTree& random, const Scene& scene) {
  LoopSpec l;
  l.name = "loop" + std::to_string(scene.loops.size());
  l.kind = LoopKind::coupler;
  l.offset = random.uniform(-1, 1);
  bool all_driven = true;
  for (int tries = 0; tries < 20 && l.joints.size() < 3; ++tries) {
    const JointSpec& j =
        scene.joints[static_cast<std::size_t>(random.below(static_cast<int>(scene.joints.size())))];
    if (j.kind == JointKind::spherical || j.kind == JointKind::free || j.kind == JointKind::weld)
      continue;
    const int coordinate = random.below(rates_of(j.kind));
    bool known = false, driven = false;
    for (std::size_t i = 0; i < l.joints.size(); ++i)
      known |= l.joints[i] == j.name && l.coordinates[i] == coordinate;
    for (const DriveSpec& d : scene.drives)
      driven |= d.joint == j.name && d.coordinate == coordinate;
    if (known) continue;
    all_driven &= driven;
    l.joints.push_back(j.name);
    l.coordinates.push_back(coordinate);
    l.ratios.push_back(random.chance(0.5) ? random.uniform(0.3, 2) : random.uniform(-2, -0.3));
  }
  if (all_driven) return std::nullopt;
  return l;
}

std::map<std::string, Eigen::Quaterniond> axes_at_zero(const Scene& scene) {
  std::map<std::string, Eigen::Quaterniond> axes{{"ground", Eigen::Quaterniond::Identity()}};
  for (const JointSpec& j : scene.joints)  // random trees list parents first
    axes[j.child] = axes.at(j.parent) * j.rotation;
  return axes;
}

LoopSpec into_plane(RandomTree& random, const Scene& scene, LoopSpec l,
                    const Eigen::Vector3d& normal) {
  const auto axes = axes_at_zero(scene);
  const Eigen::Quaterniond a = axes.at(l.child), b = axes.at(l.parent);
  l.rotation = b.conjugate() * Eigen::AngleAxisd(random.uniform(-3, 3), normal) * a;
  const bool slides = l.kind == LoopKind::prismatic || l.kind == LoopKind::slot;
  l.axis = a.conjugate() * (slides ? Eigen::Vector3d(normal.unitOrthogonal()) : normal);
  return l;
}

Ends ends_at_start(const LoopSpec& l, const Scene& scene, const Tree& tree) {
  const auto poses = DenseLagrangian(scene, tree).poses(0, tree.q0);
  const auto pose = [&](const std::string& name) -> Eigen::Isometry3d {
    for (std::size_t k = 0; k < scene.bodies.size(); ++k)
      if (scene.bodies[k].name == name) return poses[k];
    return Eigen::Isometry3d::Identity();
  };
  return {pose(l.child), pose(l.parent)};
}

void level(LoopSpec& l, const Scene& scene, const Tree& tree, const Eigen::Vector3d& normal) {
  const auto [a, b] = ends_at_start(l, scene, tree);
  const double apart = normal.dot(a * l.origin_child - b * l.origin_parent);
  l.origin_parent += apart * (b.linear().transpose() * normal);
}

void close(LoopSpec& l, const Scene& scene, const Tree& tree) {
  const auto [child, parent] = ends_at_start(l, scene, tree);
  l.origin_parent = parent.inverse() * (child * l.origin_child);
  l.rotation = Eigen::Quaterniond(parent.linear().transpose() * child.linear());
  l.rotation.normalize();
}

}  // namespace momenta::equations
