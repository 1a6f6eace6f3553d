#include "equations/random_mechanisms.h"

#include "equations/random_loops.h"

#include <momenta/core/scene/drive.h>
#include <momenta/dae/study/extremes.h>

#include <cmath>
#include <optional>

namespace momenta::equations {
namespace {

/// Equations of a loop.
int rows_of(LoopKind kind, bool planar) {
  switch (kind) {
    case LoopKind::distance:
    case LoopKind::coupler:
    case LoopKind::cam:
    case LoopKind::rack:
    case LoopKind::equation:
    case LoopKind::velocity_equation:
      return 1;
    case LoopKind::slot:
      return planar ? 1 : 2;
    case LoopKind::point:
    case LoopKind::spherical:
      return planar ? 2 : 3;
    case LoopKind::planar:
    case LoopKind::rolling:
      return 3;
    case LoopKind::universal:
    case LoopKind::cylindrical:
      return 4;
    case LoopKind::revolute:
    case LoopKind::prismatic:
      return planar ? 2 : 5;
    case LoopKind::weld:
      return planar ? 3 : 6;
  }
  return 0;
}

/// A coordinate at the start, driven or not.
double at_start(const Scene& scene, const std::string& joint, int coordinate) {
  for (const DriveSpec& d : scene.drives)
    if (d.joint == joint && d.coordinate == coordinate) {
      double f = 0, rate = 0, second = 0;
      MotionLaw(d).evaluate(0.0, f, rate, second);
      return f;
    }
  for (const JointSpec& j : scene.joints)
    if (j.name == joint && !j.position.empty())
      return j.position[static_cast<std::size_t>(coordinate)];
  return 0;
}

/// A loop of any kind closed at the start; of a distance and a coupler by their own numbers.
void close_any(LoopSpec& loop, const Scene& scene, const Tree& tree) {
  if (loop.kind == LoopKind::coupler) {
    loop.offset = 0;
    for (std::size_t i = 0; i < loop.joints.size(); ++i)
      loop.offset += loop.ratios[i] * at_start(scene, loop.joints[i], loop.coordinates[i]);
  } else if (loop.kind == LoopKind::distance) {
    const auto [child, parent] = ends_at_start(loop, scene, tree);
    loop.length = (child * loop.origin_child - parent * loop.origin_parent).norm();
  } else {
    close(loop, scene, tree);
  }
}

/// A law for the coordinate of a loop that stands at `value`: a displacement, an angle, a length or
/// the sum of a coupler.
void drive_from(RandomTree& random, Scene& scene, const LoopSpec& loop, double value) {
  DriveSpec d;
  d.loop = loop.name;
  d.kind = "polynomial";
  d.coefficients = {value, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
  scene.drives.push_back(d);
}

/// Whether a loop has one coordinate of its own, and where it stands once closed.
std::optional<double> coordinate_of(const LoopSpec& loop) {
  if (loop.kind == LoopKind::revolute || loop.kind == LoopKind::prismatic ||
      loop.kind == LoopKind::slot)
    return 0;
  if (loop.kind == LoopKind::distance) return loop.length;
  if (loop.kind == LoopKind::coupler) return loop.offset;
  return std::nullopt;
}

void change_masses(RandomTree& random, Scene& scene, int decades) {
  const double factor = std::pow(10.0, random.below(2 * decades + 1) - decades);
  if (random.chance(0.4)) {
    scene = in_units(std::move(scene), {1, 1, factor});
    return;
  }
  BodySpec& b =
      scene.bodies[static_cast<std::size_t>(random.below(static_cast<int>(scene.bodies.size())))];
  b.mass *= factor;
  b.inertia *= factor;
}

Eigen::Vector3d normal_of(const Scene& scene) {
  const auto axes = axes_at_zero(scene);
  for (const JointSpec& j : scene.joints)
    if (j.kind == JointKind::revolute || j.kind == JointKind::planar)
      return axes.at(j.child) * j.axis;
  return Eigen::Vector3d::UnitZ();
}

}  // namespace

void move_joints(RandomTree& random, Scene& scene) {
  for (JointSpec& j : scene.joints) {
    j.position.clear();
    j.velocity.clear();
    const bool turned = j.kind == JointKind::spherical || j.kind == JointKind::free;
    for (int i = turned ? 4 : 0; i < coordinates_of(j.kind); ++i)
      j.position.push_back(random.uniform(-1, 1));
    if (turned) {
      const Eigen::Quaterniond q = random.turn();
      j.position.insert(j.position.end(), {q.w(), q.x(), q.y(), q.z()});
    }
    for (int i = 0; i < rates_of(j.kind); ++i) j.velocity.push_back(random.uniform(-1, 1));
  }
}

Scene random_mechanism(RandomTree& random, const MechanismRecipe& recipe) {
  TreeRecipe tree_recipe;
  tree_recipe.bodies = recipe.bodies;
  tree_recipe.drives = recipe.drives;
  tree_recipe.joint_forces = tree_recipe.body_forces = recipe.forces;
  Scene s = recipe.planar ? random.planar_scene(tree_recipe) : random.scene(tree_recipe);
  s.name = "random mechanism";
  move_joints(random, s);
  const Tree tree = build_tree(s);
  const Eigen::Vector3d normal = normal_of(s);
  const auto any = [&](const auto& kinds) {
    return kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
  };
  int free = tree.nv;
  for (int i = 0; i < recipe.loops; ++i) {
    const LoopKind kind = recipe.planar ? any(planar_loop_kinds) : any(loop_kinds);
    if (rows_of(kind, recipe.planar) >= free) continue;
    LoopSpec l = random_loop(random, s, kind);
    if (recipe.planar) {
      l = into_plane(random, s, l, normal);
      level(l, s, tree, normal);
    }
    close_any(l, s, tree);
    s.loops.push_back(l);
    free -= rows_of(kind, recipe.planar);
  }
  if (recipe.couplers && free > 1 && random.chance(0.4))
    if (auto coupler = random_coupler(random, s)) {
      close_any(*coupler, s, tree);
      s.loops.push_back(*std::move(coupler));
      --free;
    }
  if (recipe.loop_drives)
    for (const LoopSpec& loop : s.loops)
      if (const auto value = coordinate_of(loop); value && free > 0 && random.chance(0.4)) {
        drive_from(random, s, loop, *value);
        if (loop.kind != LoopKind::distance && loop.kind != LoopKind::coupler) --free;
      }
  if (recipe.redundant && !s.loops.empty()) {
    LoopSpec again =
        s.loops[static_cast<std::size_t>(random.below(static_cast<int>(s.loops.size())))];
    again.name += "again";
    bool driven = false;
    for (const DriveSpec& d : s.drives) driven |= d.loop + "again" == again.name;
    if (!driven) s.loops.push_back(std::move(again));
  }
  if (recipe.decades > 0) change_masses(random, s, recipe.decades);
  return s;
}

}  // namespace momenta::equations
