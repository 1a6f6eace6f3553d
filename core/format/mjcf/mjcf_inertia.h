#pragma once
// Masses and inertias of MJCF: <inertial>, or the sum over a body's geoms.

#include <momenta/core/format/mjcf/mjcf_meshes.h>

#include <array>
#include <string_view>

namespace momenta::reading {

enum class GeomShape { sphere, capsule, ellipsoid, cylinder, box, plane, hfield, mesh, sdf };
inline constexpr std::array<std::string_view, 9> geom_shapes{
    "sphere", "capsule", "ellipsoid", "cylinder", "box", "plane", "hfield", "mesh", "sdf"};
/// Radius and half length, or three half lengths, by shape; `fromto` gives the length along z.
/// @throws SceneError for numbers that are missing or not positive
Eigen::Vector3d geom_size(const Node& geom, GeomShape shape);

/// Mass, centre of mass and the inertia about it, in axes of the body.
struct MjcfInertia {
  double mass = 0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();

  /// Adds another: m = m1 + m2, com the mean of both, inertias moved there by Steiner's rule.
  void add(const MjcfInertia& other);
};

/// An inertia in a frame, expressed in the axes around it.
MjcfInertia operator*(const MjcfFrame& frame, const MjcfInertia& inner);

/// <inertial pos mass (diaginertia, orientation | fullinertia)>.
MjcfInertia read_inertial(const Node& node, const MjcfAngles& angles);

/// A body after `boundmass`, `boundinertia` and `balanceinertia` (mjcf_inertia.cpp).
MjcfInertia bounded(const MjcfInertia& body, const MjcfSettings& settings);

/// A <geom> with its defaults, by its `mass` or `density` (default 1000 kg/m³).
/// Solid:
///   sphere r            V = 4/3 π r³                  2/5 m r²
///   ellipsoid a b c     V = 4/3 π a b c               m/5 (b² + c²), …
///   box a b c (halves)  V = 8 a b c                   m/3 (b² + c²), …
///   cylinder r, half h  V = 2 π r² h                  m (3 r² + (2h)²)/12, m r²/2 about z
///   capsule r, half h   a cylinder and two half balls: of these, with their mass s,
///                       s (2/5 r² + h² + 3/4 h r) across, 2/5 s r² about z
///   mesh                see MjcfMeshes
/// With `shellinertia` the surface alone, and `density` is per area: with P = ∫ x² + y² and Z = ∫
/// z² over its area A, m P/A about z and m (P/2 + Z)/A across:
///   sphere              A = 4 π r²                    P = 2/3 r² A, Z = 1/3 r² A
///   cylinder            A = 4 π r h + 2 π r²          P = 4 π r h r² + π r⁴,
///                                                     Z = 4/3 π r h³ + 2 π r² h²
///   capsule             A = 4 π r h + 4 π r²          P = 4 π r h r² + 8/3 π r⁴,
///                                                     Z = 4/3 π r h³ + 4 π r² (h² + h r + r²/3)
///   box                 A = 8 (ab + bc + ca)          ∫ x² = 8 a² (bc + (ab + ca)/3), …
/// The shell of an ellipsoid has no such formula and is refused. Planes and height fields have no
/// mass.
/// Meshes of a body `at_rest` are not weighed: its inertia does not matter.
MjcfInertia read_geom(const Node& geom, const MjcfAngles& angles, bool at_rest, MjcfMeshes& meshes,
                      Remarks& remarks);

}  // namespace momenta::reading
