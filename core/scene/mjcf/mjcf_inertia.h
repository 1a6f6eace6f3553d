#pragma once
// Masses and inertias of MJCF: <inertial>, or the sum over a body's geoms.

#include <momenta/core/scene/mjcf/mjcf_frames.h>

namespace momenta::reading {

/// Mass, centre of mass and the inertia about it, in axes of the body.
struct MjcfInertia {
  double mass = 0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();

  /// The two as one: m = m1 + m2, com the mean of both, inertias moved there by Steiner's rule.
  void add(const MjcfInertia& other);
};

/// <inertial pos mass (diaginertia, orientation | fullinertia)>.
MjcfInertia read_inertial(const Node& node, const MjcfAngles& angles);

/// A <geom> with its defaults, solid, of its `mass` or of `density` (1000 kg/m³ where neither is
/// given):
///   sphere r            V = 4/3 π r³                  2/5 m r²
///   ellipsoid a b c     V = 4/3 π a b c               m/5 (b² + c²), …
///   box a b c (halves)  V = 8 a b c                   m/3 (b² + c²), …
///   cylinder r, half h  V = 2 π r² h                  m (3 r² + (2h)²)/12, m r²/2 about z
///   capsule r, half h   a cylinder and two half balls: of these, with their mass s,
///                       s (2/5 r² + h² + 3/4 h r) across, 2/5 s r² about z
/// Planes and height fields have no mass. A mesh has one that is not known here: it is refused
/// unless its mass or density is 0, or `at_rest`, where no inertia matters.
MjcfInertia read_geom(const Node& geom, const MjcfAngles& angles, bool at_rest);

}  // namespace momenta::reading
