#pragma once
// The kinds of joints of a scene, and how many numbers each adds to the state. q and u differ in
// size where the rates are quasi-velocities (angular velocities in body axes): there p = Eᵀ P* =
// ∂T/∂u is not canonical, and (35) holds unchanged.
//
// A tree has fewer kinds: cylindrical, universal and planar joints, and fully driven spherical and
// free joints, become chains of revolute and prismatic joints with massless bodies between them. So
// E is constant in body axes for every such joint, and q, p, q̇, ṗ are those of the joint as a
// whole. A user joint is a formula of a program (core/user_joint.h): its E varies in body axes, and
// the formula says how many numbers it has.

#include <cstddef>

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
  free,  ///< all six degrees of freedom
  weld,  ///< no degree of freedom
  user   ///< a formula of the program: core/user_joint.h
};

/// Size of q: a unit quaternion w x y z for spherical; position, then quaternion for free. For user
/// joints, whose size the kind does not tell, it is 0: use coordinates_of(JointSpec).
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

/// Size of u and p: the number of columns of the joint matrix E, eq. (13). Also how many
/// coordinates drives can prescribe: roll, pitch, yaw for a spherical joint; x, y, z, roll, pitch,
/// yaw for a free one.
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

/// How many coordinates are angles and displacements by themselves: all where q̇ = u and the joint
/// is one of, or a chain of, revolute, prismatic and helical ones.
constexpr std::size_t scalar_coordinates_of(JointKind kind) {
  return coordinates_of(kind) == rates_of(kind) ? static_cast<std::size_t>(rates_of(kind)) : 0;
}

/// How many numbers its rotors' inertia has (JointSpec::rotor_inertia): one for each of those
/// coordinates; of a spherical joint one for all its rates.
constexpr std::size_t rotors_of(JointKind kind) {
  return kind == JointKind::spherical ? 1 : scalar_coordinates_of(kind);
}

/// Whether the joint has one coordinate, along which a spring, a damper or a torque can act.
constexpr bool has_one_coordinate(JointKind kind) {
  return rates_of(kind) == 1;
}

}  // namespace momenta
