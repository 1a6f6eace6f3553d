#include "equations/random_tree.h"
#include "equations/parts.h"

#include <cmath>
#include <map>

namespace momenta::equations {

Eigen::Vector3d RandomTree::direction() {
  for (;;)
    if (const Eigen::Vector3d v = vector(1); v.norm() > 0.1 && v.norm() < 1) return v.normalized();
}

Eigen::Quaterniond RandomTree::turn() {
  const Eigen::Vector3d axis = direction();
  return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(-3.1, 3.1), axis));
}

Eigen::Matrix3d RandomTree::inertia(double mass) {
  const double z = uniform(0.2, 1), y = uniform(0.2, 1), x = uniform(0.2, 1);
  Eigen::Vector3d edge(x, y, z);
  edge = edge.cwiseAbs2();
  const Eigen::Vector3d moments =
      mass / 12 * Eigen::Vector3d(edge.y() + edge.z(), edge.z() + edge.x(), edge.x() + edge.y());
  const Eigen::Matrix3d r = turn().toRotationMatrix();
  const Eigen::Matrix3d j = r * moments.asDiagonal() * r.transpose();
  return 0.5 * (j + j.transpose());
}

Scene RandomTree::scene(const TreeRecipe& recipe) {
  Scene s;
  s.name = "random tree";
  if (recipe.gravity) s.gravity = 9.81 * direction();
  for (int k = 0; k < recipe.bodies; ++k) {
    s.bodies.push_back(body(k));
    s.joints.push_back(joint(recipe, k));
    effects(recipe, s, k);
  }
  return s;
}

Scene RandomTree::planar_scene(const TreeRecipe& recipe) {
  TreeRecipe flat = recipe;
  flat.kinds.clear();
  for (const JointKind kind : recipe.kinds)
    if (kind == JointKind::revolute || kind == JointKind::prismatic || kind == JointKind::planar ||
        kind == JointKind::weld)
      flat.kinds.push_back(kind);
  Eigen::Vector3d normal = chance(0.5) ? direction() : Eigen::Vector3d::Unit(below(3));
  if (chance(0.5)) normal = -normal;
  const Eigen::Vector3d across = normal.unitOrthogonal();
  Scene s = scene(flat);
  std::map<std::string, Eigen::Quaterniond> axes{{"ground", Eigen::Quaterniond::Identity()}};
  for (JointSpec& j : s.joints) {
    const Eigen::Quaterniond joint_axes = axes.at(j.parent) * j.rotation;
    axes[j.child] = joint_axes;  // at q = 0
    const bool across_plane = j.kind == JointKind::revolute || j.kind == JointKind::planar;
    const Eigen::Vector3d axis = across_plane ? Eigen::Vector3d((chance(0.5) ? 1 : -1) * normal)
                                              : Eigen::AngleAxisd(uniform(-3, 3), normal) * across;
    j.axis = (joint_axes.conjugate() * axis).normalized();
    if (j.kind == JointKind::planar && j.direction != Eigen::Vector3d::Zero())
      j.direction = inclined(j.axis);
  }
  return s;
}

TreeState RandomTree::state(const Tree& tree) {
  TreeState s;
  s.t = uniform(0, 1);
  s.q = Eigen::VectorXd::Zero(tree.nq);
  s.u = Eigen::VectorXd::Zero(tree.nv);
  for (const Tree::Body& b : tree.bodies) {
    const bool turns = b.kind == JointKind::revolute || b.kind == JointKind::helical;
    const double reach = turns ? 3 : 0.5;
    for (int i = 0; i < b.nq; ++i) s.q[b.q + i] = uniform(-reach, reach);
    for (int i = 0; i < b.nv; ++i) s.u[b.u + i] = uniform(-1.5, 1.5);
    if (b.nq < 4) continue;
    const Eigen::Quaterniond turned = turn();
    s.q.segment<4>(b.q + b.nq - 4) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  return s;
}

DriveSpec RandomTree::drive(const std::string& joint, int coordinate) {
  DriveSpec d;
  d.joint = joint;
  d.coordinate = coordinate;
  switch (below(4)) {
    case 0:
      d.kind = "polynomial";
      for (int i = 0; i < 4; ++i) d.coefficients.push_back(uniform(-1, 1));
      break;
    case 1:
      d.kind = "harmonic";
      d.offset = uniform(-1, 1);
      d.amplitude = uniform(-1, 1);
      d.frequency = uniform(0.5, 3);
      d.phase = uniform(-3, 3);
      break;
    case 2:
      d.kind = "step";
      d.from = uniform(-1, 1);
      d.to = uniform(-1, 1);
      d.start = -0.5;
      d.duration = 2;
      break;
    case 3:  // states are between 0 and 1
      d.kind = "table";
      d.times = {-0.3, 0.2, 0.45, 0.9, 1.2};
      for (std::size_t i = 0; i < d.times.size(); ++i) d.values.push_back(uniform(-1, 1));
      break;
  }
  return d;
}

BodySpec RandomTree::body(int k) {
  BodySpec b;
  b.name = body_name(k);
  b.mass = uniform(0.5, 2);
  b.com = vector(0.4);
  b.inertia = inertia(b.mass);
  return b;
}

JointSpec RandomTree::joint(const TreeRecipe& recipe, int k) {
  JointSpec j = make_joint(
      recipe.kinds[static_cast<std::size_t>(below(static_cast<int>(recipe.kinds.size())))],
      "joint" + std::to_string(k), "ground", body_name(k));
  switch (recipe.branching) {
    case Branching::serial:
      j.parent = body_name(k - 1);
      break;
    case Branching::star:
      j.parent = body_name(k == 0 ? -1 : 0);
      break;
    case Branching::random:
      j.parent = body_name(below(k + 1) - 1);
      break;
  }
  switch (recipe.placing) {
    case Placing::general:
      j.origin_parent = vector(0.7);
      j.origin_child = vector(0.4);
      j.rotation = turn();
      j.axis = direction();
      break;
    case Placing::right_angles:
      for (int i = 0; i < 3; ++i) j.origin_parent[i] = below(3) - 1;
      j.axis = Eigen::Vector3d::Unit(below(3));
      j.rotation = Eigen::AngleAxisd(below(4) * std::acos(0.0), j.axis);
      j.axis = Eigen::Vector3d::Unit(below(3));
      if (!chance(0.5)) j.axis = -j.axis;
      break;
    case Placing::degenerate:
      // The scene's axes stay nearly parallel, so axes do too; offsets along them, across, none.
      j.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(tilt(), direction()));
      if (chance(0.3)) j.rotation = Eigen::Quaterniond(0, 1, 0, 0) * j.rotation;
      j.axis = (Eigen::AngleAxisd(tilt(), direction()) * Eigen::Vector3d::UnitZ()).normalized();
      if (chance(0.5)) j.axis = -j.axis;
      if (chance(0.7)) j.origin_parent = vector(0.7);
      if (chance(0.3)) j.origin_parent.head<2>().setZero();
      if (chance(0.3)) j.origin_parent *= 1e-9;
      if (chance(0.3)) j.origin_child = vector(0.4);
      break;
  }
  if (j.kind == JointKind::helical) j.pitch = uniform(-0.5, 0.5);
  if (j.kind == JointKind::universal && chance(0.7)) j.axis2 = inclined(j.axis);
  if (j.kind == JointKind::planar && chance(0.7)) j.direction = inclined(j.axis);
  return j;
}

Eigen::Vector3d RandomTree::inclined(const Eigen::Vector3d& axis) {
  for (;;)
    if (const Eigen::Vector3d v = direction(); v.cross(axis).norm() > 0.3) return v;
}

double RandomTree::tilt() {
  switch (below(4)) {
    case 0:
      return 0;
    case 1:
      return uniform(0.04, 0.06);
    default:
      return std::pow(10.0, uniform(-12, -3));
  }
}

/// Choices of its own: whether rotors are asked for changes nothing else.
void RandomTree::rotors(JointSpec& j) {
  const std::size_t count = rotors_of(j.kind);
  if (count == 0) return;
  if (!bytes_.empty()) {
    if (chance(0.3)) j.rotor_inertia.assign(count, uniform(0, 2));
    return;
  }
  if (rotor_bits_() % 3 != 0) return;
  for (std::size_t i = 0; i < count; ++i)
    j.rotor_inertia.push_back(static_cast<double>(rotor_bits_() % 1000) / 500);
}

void RandomTree::effects(const TreeRecipe& recipe, Scene& s, int k) {
  JointSpec& j = s.joints.back();
  const bool together = j.kind == JointKind::spherical || j.kind == JointKind::free;
  const bool all = together && chance(0.2);
  bool driven = false;
  for (int i = 0; recipe.drives && i < rates_of(j.kind); ++i)
    if (together ? all : chance(0.25)) {
      s.drives.push_back(drive(j.name, i));
      driven = true;
    }
  if (has_one_coordinate(j.kind) && !driven && recipe.joint_forces && chance(0.5)) {
    j.stiffness = uniform(0, 10);
    j.rest = uniform(-1, 1);
    j.damping = uniform(0, 2);
    ForceSpec torque;
    torque.kind = "torque";
    torque.joint = j.name;
    torque.value = uniform(-3, 3);
    s.forces.push_back(torque);
  }
  if (recipe.rotors) rotors(j);
  if (!recipe.body_forces) return;
  if (chance(0.3)) {
    ForceSpec spring;
    spring.kind = "spring-damper";
    spring.child = body_name(k);
    spring.parent = body_name(below(k + 1) - 1);
    spring.origin_parent = vector(1);
    spring.origin_child = vector(1);
    spring.stiffness = uniform(0, 20);
    spring.damping = uniform(0, 3);
    spring.rest = uniform(0, 1);
    s.forces.push_back(spring);
  }
  if (chance(0.3)) {
    ForceSpec wrench;
    wrench.kind = "wrench";
    wrench.body = body_name(k);
    wrench.point = vector(0.5);
    wrench.force = vector(5);
    wrench.torque = vector(2);
    wrench.in_body_axes = chance(0.5);
    s.forces.push_back(wrench);
  }
}

}  // namespace momenta::equations
