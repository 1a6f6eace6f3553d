#pragma once
// The joints a scene may have, and how many numbers each brings to the state. q and u differ in
// number where the rates are quasi-velocities (angular velocities in body axes): there p = Eᵀ P* =
// ∂T/∂u is not canonical, and (35) holds unchanged.
//
// A tree knows fewer: cylindrical, universal and planar joints, and fully driven spherical and free
// ones, become chains of revolute and prismatic joints with massless bodies between them. Then E is
// constant in body axes for every joint of a tree, and q, p, q̇, ṗ are those of the joint as a
// whole. A user joint is a formula of a program (core/user_joint.h): its E moves in body axes, and
// its numbers are those of its formula.

namespace momenta {

/// The kinds of joints of a scene; their coordinates: JointSpec.
enum class JointKind {
  revolute,
  prismatic,
  helical,
  cylindrical,
  universal,
  spherical,
  planar,
  free,  ///< all six: no joint at all
  weld,  ///< none
  user   ///< a formula of the program: core/user_joint.h
};

/// Size of q: a unit quaternion w x y z for spherical; position, then quaternion for free. Of a
/// user joint the kind alone does not know it: coordinates_of(JointSpec) does.
constexpr int coordinates_of(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::helical:
      return 1;
    case JointKind::cylindrical:
    case JointKind::universal:
      return 2;
    case JointKind::planar:
      return 3;
    case JointKind::spherical:
      return 4;
    case JointKind::free:
      return 7;
    case JointKind::weld:
    case JointKind::user:
      return 0;
  }
  return 0;
}

/// Size of u and p: columns of the joint matrix E, eq. (13). Also how many coordinates drives can
/// prescribe: those of a spherical joint are then roll, pitch, yaw, those of a free one x, y, z and
/// these.
constexpr int rates_of(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::helical:
      return 1;
    case JointKind::cylindrical:
    case JointKind::universal:
      return 2;
    case JointKind::spherical:
    case JointKind::planar:
      return 3;
    case JointKind::free:
      return 6;
    case JointKind::weld:
    case JointKind::user:
      return 0;
  }
  return 0;
}

/// One coordinate, which a spring, a damper or a torque can act along.
constexpr bool has_one_coordinate(JointKind kind) {
  return rates_of(kind) == 1;
}

}  // namespace momenta
