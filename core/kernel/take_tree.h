#pragma once
// Parts of a model that do not depend on its algebra: joints, masses and forces of tree and scene.
// Included only where models are built.

#include <momenta/core/kernel/take_formulas.h>
#include <momenta/core/kernel/user_motion.h>

namespace momenta {

/// Joints, drives, sizes and the mass of every subtree. Frames and edges are the builder's.
template <class Space>
void take_joints(const Tree& tree, Model<Space>& model) {
  const std::size_t n = tree.bodies.size();
  model.bodies.resize(n);
  model.frames.resize(n, Eigen::Isometry3d::Identity());
  model.nq = tree.nq;
  model.nv = tree.nv;
  model.drives = tree.drives;
  for (std::size_t k = n; k-- > 0;) {
    const Tree::Body& b = tree.bodies[k];
    auto& m = model.bodies[k];
    m.kind = b.kind;
    m.parent = b.parent;
    m.drive = b.drive;
    m.q = b.q;
    m.nq = b.nq;
    m.u = b.u;
    m.nv = b.nv;
    m.pitch = b.pitch;
    m.stiffness = b.stiffness;
    m.rest = b.rest;
    m.damping = b.damping;
    m.torque = b.torque;
    m.friction = b.nv == 1 ? b.friction : 0;
    m.friction_rate = b.friction_rate;
    if (b.nv == 1) m.stop = {b.least, b.largest, b.stop_stiffness, b.stop_damping, b.stop_width};
    m.is_curved = m.friction != 0 || m.stop.acts();
    m.rotor = b.rotor;
    model.has_rotors |= m.has_rotor();
    if (b.kind == JointKind::user) {
      m.law = static_cast<const UserFormula*>(b.law.get());  // ensured by JointFormula
      m.user = static_cast<int>(model.laws.size());
      model.laws.push_back(b.law);
    }
    model.has_joint_forces |= m.stiffness != 0 || m.damping != 0 || m.torque != 0 || m.is_curved;
    m.subtree_mass += b.mass;
    if (m.parent >= 0)
      model.bodies[static_cast<std::size_t>(m.parent)].subtree_mass += m.subtree_mass;
  }
}

/// Stops of a joint, or of a force along a length, with limits.
template <class Spec>
JointStop stop_of(const Spec& s) {
  if (!s.limits) return {};
  return {(*s.limits)[0], (*s.limits)[1], s.stop_stiffness, s.stop_damping, s.stop_width};
}

/// Springs, bushings, wrenches and formulas, stops of spherical joints. Needs the frames of all
/// bodies.
template <class Space>
void take_forces(const Tree& tree, const Scene& scene, Model<Space>& model) {
  constexpr bool in_plane = Space::dimension == 3;
  SignalTaker<Space> taker(tree, scene, model);
  // Common to springs and bushings: two points, of bodies k and c.
  const auto take_points = [&](const ForceSpec& f, auto& between) {
    taker.take_points(f, between);
    between.stiffness = f.stiffness;
    between.damping = f.damping;
  };
  const auto take_bushing = [&](const ForceSpec& f, const JointStop& stop) {
    typename Model<Space>::Bushing bushing;
    take_points(f, bushing);
    bushing.rotational_stiffness = f.rotational_stiffness;
    bushing.rotational_damping = f.rotational_damping;
    bushing.stop = stop;
    if constexpr (!in_plane) {
      // Σ p_i c_iᵀ: p_i the child's axes without couple, c_i its axes
      const Eigen::Quaterniond turn = f.rotation.normalized();
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
        const auto on_parent =
            model.direction(bushing.parent, tree.direction(bushing.parent, turn * unit));
        const auto on_child = model.direction(bushing.child, tree.direction(bushing.child, unit));
        for (int j = 0; j < 3; ++j)
          bushing.rest_axes[static_cast<std::size_t>(j)] += on_child[j] * on_parent;
      }
    }
    model.bushings.push_back(bushing);
  };
  for (const JointSpec& joint : scene.joints) {
    if (joint.kind != JointKind::spherical || !has_stops(joint)) continue;
    ForceSpec between;
    between.parent = joint.parent;
    between.child = joint.child;
    between.origin_parent = joint.origin_parent;
    between.origin_child = joint.origin_child;
    between.rotation = joint.rotation;
    take_bushing(between, stop_of(joint));
  }
  for (const ForceSpec& f : scene.forces) {
    if (!f.law.empty()) continue;  // take_formulas.h
    const bool of_length = f.kind == "spring-damper" || f.kind == "coordinate-spring";
    const bool told = f.limits && f.kind == "spring-damper";  // the sentences ask for its length
    if (of_length && f.stiffness == 0 && f.damping == 0 && !stop_of(f).acts() && !told) continue;
    if (f.kind == "spring-damper") {
      typename Model<Space>::Spring spring;
      take_points(f, spring);
      spring.rest = f.rest;
      spring.band = f.dead_band;
      spring.stop = stop_of(f);
      spring.limited = f.limits.has_value();
      model.has_corners |= f.dead_band != 0 || spring.stop.acts();
      model.springs.push_back(spring);
    } else if (f.kind == "bushing") {
      take_bushing(f, {});
    } else if (f.kind == "coordinate-spring") {
      typename Model<Space>::CoordinateSpring spring;
      spring.stiffness = f.stiffness;
      spring.damping = f.damping;
      spring.rest = f.rest;
      spring.band = f.dead_band;
      spring.stop = stop_of(f);
      spring.terms = taker.sum(f);
      model.coordinate_springs.push_back(spring);
    } else if (f.kind == "wrench") {
      typename Model<Space>::Wrench wrench;
      wrench.body = tree.body(f.body);
      wrench.at = model.point(wrench.body, tree.point(wrench.body, f.point));
      wrench.in_body_axes = f.in_body_axes;
      const int axes_of = f.in_body_axes ? wrench.body : -1;
      const Eigen::Vector3d torque = tree.direction(axes_of, f.torque);
      wrench.force = model.direction(axes_of, tree.direction(axes_of, f.force));
      if constexpr (in_plane)
        wrench.normal_torque = taker.across(axes_of, torque, false);
      else
        wrench.torque = model.direction(axes_of, torque);
      model.wrenches.push_back(wrench);
    }
  }
  take_formulas(scene, taker, model);
}

}  // namespace momenta
