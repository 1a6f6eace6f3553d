#pragma once
// Kinds of joints of a scene, and their numbers of coordinates and rates. These differ where the
// rates are quasi-velocities (angular velocities in body axes): there p = Eᵀ P* = ∂T/∂u is not
// canonical, and (35) holds unchanged.
//
// A tree has fewer kinds: cylindrical, universal and planar joints, and fully driven spherical and
// free joints, become chains of revolute and prismatic joints with massless bodies between them. So
// E is constant in body axes, and q, p, q̇, ṗ are those of the whole joint. A user joint is a
// formula of a program (core/open_chain/user_joint.h), which says how many coordinates it has; its
// E varies in body axes.

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
  user   ///< a formula of the program: core/open_chain/user_joint.h
};

/// Size of q: a unit quaternion w x y z for spherical; position, then quaternion for free; 0 for
/// user joints, whose size the kind does not tell: use coordinates_of(JointSpec).
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

/// Size of u and p: the number of columns of the joint matrix E, eq. (13). Also the number of
/// coordinates that drives can prescribe: roll, pitch, yaw for a spherical joint; x, y, z, roll,
/// pitch, yaw for a free one.
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

/// Number of coordinates that are angles and displacements by themselves: all where q̇ = u and the
/// joint is one, or a chain, of revolute, prismatic and helical ones.
constexpr std::size_t scalar_coordinates_of(JointKind kind) {
  return coordinates_of(kind) == rates_of(kind) ? static_cast<std::size_t>(rates_of(kind)) : 0;
}

/// Size of JointSpec::rotor_inertia: one number for each of those coordinates, one for all rates of
/// a spherical joint.
constexpr std::size_t rotors_of(JointKind kind) {
  return kind == JointKind::spherical ? 1 : scalar_coordinates_of(kind);
}

/// Whether the joint has one coordinate, along which a spring, a damper or a torque can act.
constexpr bool has_one_coordinate(JointKind kind) {
  return rates_of(kind) == 1;
}

}  // namespace momenta
