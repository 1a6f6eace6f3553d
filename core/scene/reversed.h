#pragma once
// Joints and loops seen from their child: parent and child change places, the relative motion
// stays. The new frame has the axes of the old parent; there the old frame is `rotation`.

#include <momenta/core/scene/joint_spec.h>
#include <momenta/core/scene/loop_spec.h>

#include <algorithm>
#include <utility>

namespace momenta {

/// Whether q and u of a joint mean the same, up to order, once it is turned round.
inline bool keeps_coordinates(JointKind kind) {
  return kind == JointKind::revolute || kind == JointKind::prismatic ||
         kind == JointKind::helical || kind == JointKind::cylindrical ||
         kind == JointKind::universal || kind == JointKind::weld;
}

/// Whether parent and child of a loop can change places.
inline bool can_turn_round(const LoopSpec& loop) {
  switch (loop.kind) {
    case LoopKind::point:
    case LoopKind::spherical:
    case LoopKind::revolute:
    case LoopKind::weld:
    case LoopKind::prismatic:
    case LoopKind::universal:
    case LoopKind::cylindrical:
    case LoopKind::planar:
    case LoopKind::distance:
      return true;
    case LoopKind::coupler:
    case LoopKind::slot:
    case LoopKind::cam:
    case LoopKind::rack:
    case LoopKind::equation:
    case LoopKind::velocity_equation:
    case LoopKind::rolling:
      break;
  }
  return false;
}

/// Exchanges bodies, points and axes of a joint or a loop.
template <class Spec>
Spec with_ends_exchanged(const Spec& spec, bool universal, bool planar) {
  Spec t = spec;
  std::swap(t.parent, t.child);
  std::swap(t.origin_parent, t.origin_child);
  t.rotation = spec.rotation.conjugate();
  t.axis = -(spec.rotation * spec.axis);
  if (universal) {
    const Eigen::Vector3d second = spec.axis2.isZero() ? perpendicular_to(spec.axis) : spec.axis2;
    t.axis2 = t.axis;
    t.axis = -(spec.rotation * second);
  } else if (planar && !spec.direction.isZero()) {
    t.direction = spec.rotation * spec.direction;
  }
  return t;
}

/// The joint seen from its child: same q and u for kinds with one axis and for welds; the
/// coordinates of a universal joint change places. Other kinds have other q and u, left empty.
inline JointSpec reversed(const JointSpec& joint) {
  const bool universal = joint.kind == JointKind::universal;
  JointSpec t = with_ends_exchanged(joint, universal, joint.kind == JointKind::planar);
  if (universal) {
    std::reverse(t.position.begin(), t.position.end());
    std::reverse(t.velocity.begin(), t.velocity.end());
    std::reverse(t.rotor_inertia.begin(), t.rotor_inertia.end());
  }
  if (!keeps_coordinates(joint.kind)) t.position = t.velocity = {};
  return t;
}

/// The same loop seen from its child. @pre not driven, can_turn_round(loop)
inline LoopSpec reversed(const LoopSpec& loop) {
  return with_ends_exchanged(loop, loop.kind == LoopKind::universal, loop.kind == LoopKind::planar);
}

}  // namespace momenta
