#pragma once
// A loop of a scene: a joint that closes it, curves in planes of bodies that do, or an equation.

#include <momenta/core/scene/location.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

namespace momenta {

/// A curve about a point of a body, in the plane across a loop's `axis`. A parent's curve is in the
/// loop frame, a child's in the child's axes.
///   - "circle": `radius` about the point
///   - "ellipse": about the point, `semi_axes` along `direction` and across it
///   - "spline": the cubic spline through `points`, over the length of its chords: closed, or
///     natural with straight ends
///   - "flat": the straight line through the point, `direction` its outward normal
struct CurveSpec {
  std::string kind;                   ///< circle ellipse spline flat, or empty
  double radius = 0;                  ///< circle [m], > 0
  std::array<double, 2> semi_axes{};  ///< ellipse [m], > 0
  /// Ellipse: zero means perpendicular_to(axis); flat. A unit vector across `axis`.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points;  ///< spline: from the point, in the plane [m]
  bool closed = false;                  ///< spline: from the last point back to the first
};

/// The kinds of loops, with their number of equations; the equations: LoopSpec.
enum class LoopKind {
  point,              ///< 3 equations, 2 in a plane
  revolute,           ///< 5
  spherical,          ///< 3, as point
  weld,               ///< 6
  prismatic,          ///< 5
  distance,           ///< 1
  universal,          ///< 4
  cylindrical,        ///< 4
  planar,             ///< 3
  coupler,            ///< 1, between coordinates of joints
  slot,               ///< 2, in a plane 1
  cam,                ///< 1
  rack,               ///< 1
  equation,           ///< 1, between coordinates, positions of markers and the time
  velocity_equation,  ///< 1, between rates and velocities of markers; nonholonomic
  rolling             ///< 3: contact, and two of the slip, which are nonholonomic
};

/// A joint that closes a loop. It has the keys of a joint, but no coordinates or forces. Its child
/// is a body, its parent another body or "ground".
///   - `point` and `spherical` are the same three equations
///   - `distance` keeps |origin_parent − origin_child| = length
///   - `universal` keeps the points together and `axis`, held by the parent, at its angle to
///     `axis2`, held by the child
///   - `planar` keeps the child's point in the plane across `axis`, and `axis` common
///   - `coupler` ties coordinates of joints, not bodies: Σ ratios[i] q_i + Σ powers[k] x^(k+2) =
///     offset, x the coordinate of the last joint
///   - `slot` keeps the child's point on a curve of the parent: without `curve` on the line along
///     `axis`, else on a circle or spline in the plane across `axis`
///   - `cam` keeps the outlines `curve` of the parent and `child_curve` of the child, both in the
///     plane across `axis`, in contact: no gap along their common normal. It pulls as well as
///     pushes. Both bodies move across `axis`
///   - `rack`: the circle of the child with `radius` about origin_child rolls on the parent's line
///     through origin_parent along `direction`, on its side axis × direction: the angle of the
///     child about `axis` is `offset` − displacement / radius. The distance from the line is not
///     held
///   - `equation`: the formula `equation` is zero, of joint coordinates, positions of markers and t
///     (core/scene/formula.h). It has no bodies of its own
///   - `velocity_equation`: the formula `equation` is zero, linear in rates of joint coordinates
///     and velocities of markers, with coefficients of coordinates, positions of markers and t
///   - `rolling`: the wheel of the child rolls without slipping on the plane of the parent through
///     origin_parent, on the side to which `normal` points: a circle about origin_child across
///     `axis`, of radius `radius` − `crown_radius`, thickened by `crown_radius`. A crown radius of
///     0 makes the wheel a disc with a sharp edge, one of `radius` a sphere. It pulls as well as
///     pushes
struct LoopSpec {
  std::string name;                                              ///< unique among joints and loops
  LoopKind kind = LoopKind::point;                               ///< point, revolute, …
  std::string parent = "ground";                                 ///< a body, or "ground"
  std::string child;                                             ///< a body, not the parent
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();       ///< in parent axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();        ///< in child axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< loop frame in parent axes
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();               ///< unit vector in the loop frame
  /// Universal: as in JointSpec; zero means perpendicular_to(axis).
  Eigen::Vector3d axis2 = Eigen::Vector3d::Zero();
  /// Planar: as in JointSpec, for driven coordinates; rack: its line; zero means
  /// perpendicular_to(axis).
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0;  ///< distance [m]; no effect where driven
  /// Coupler: joints with u = q̇, driven or not; no coordinate occurs twice.
  std::vector<std::string> joints;
  std::vector<int> coordinates;  ///< counted as in DriveSpec, one for each joint; empty: all 0
  std::vector<double> ratios;    ///< [1, rad/m or m/rad], not zero, one for each joint
  /// Coefficients of x² to x⁴, x the coordinate of the last joint; with one that is not zero, that
  /// joint's ratio may be 0.
  std::vector<double> powers;
  double offset = 0;        ///< [rad or m]; no effect where driven
  CurveSpec curve;          ///< slot: circle or spline, or none; cam: outline of the parent
  CurveSpec child_curve;    ///< cam: outline of the child
  double radius = 0;        ///< rack: radius; rolling: largest radius [m], > 0
  double crown_radius = 0;  ///< rolling [m], 0 to `radius`
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< rolling: unit vector in the loop frame
  std::string equation;  ///< equation, velocity equation: a formula, without corners
  Location at;           ///< where the file has it
};

/// Whether a coupler is not linear.
bool has_powers(const LoopSpec& loop);

/// Whether a loop ties its parent and its child, not coordinates or names in formulas.
bool ties_bodies(const LoopSpec& loop);

/// Whether a loop is a formula, of positions or of velocities.
bool has_equation(const LoopSpec& loop);

/// Whether a loop is a higher pair of curves: a curved slot, a cam, a rack.
bool has_curves(const LoopSpec& loop);

/// Number of coordinates of a loop that drives can prescribe: those of a joint of the same kind,
/// the length of a distance, the offset of a coupler, the displacement in a straight slot.
constexpr int driven_coordinates_of(LoopKind kind) {
  switch (kind) {
    case LoopKind::revolute:
    case LoopKind::prismatic:
    case LoopKind::distance:
    case LoopKind::coupler:
    case LoopKind::slot:
      return 1;
    case LoopKind::universal:
    case LoopKind::cylindrical:
      return 2;
    case LoopKind::spherical:
    case LoopKind::planar:
      return 3;
    case LoopKind::point:
    case LoopKind::weld:
    case LoopKind::cam:
    case LoopKind::rack:
    case LoopKind::equation:
    case LoopKind::velocity_equation:
    case LoopKind::rolling:
      return 0;
  }
  return 0;
}

}  // namespace momenta
