#pragma once
// The joints a tree may have, and how many numbers each brings to the state. q and u differ in
// number where the rates are quasi-velocities (angular velocities in body axes): there p = Eᵀ P* =
// ∂T/∂u is not canonical, and (35) holds unchanged.

namespace momenta {

enum class JointKind { revolute, prismatic, spherical, free, weld };

/// Size of q: a unit quaternion w x y z for spherical; position, then quaternion for free.
constexpr int coordinates_of(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
      return 1;
    case JointKind::spherical:
      return 4;
    case JointKind::free:
      return 7;
    case JointKind::weld:
      return 0;
  }
  return 0;
}

/// Size of u and p: columns of the joint matrix E, eq. (13).
constexpr int rates_of(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
      return 1;
    case JointKind::spherical:
      return 3;
    case JointKind::free:
      return 6;
    case JointKind::weld:
      return 0;
  }
  return 0;
}

}  // namespace momenta
