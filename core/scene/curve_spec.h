#pragma once
// Curves in a plane of a body: paths of points, and outlines that touch.

#include <Eigen/Core>
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

}  // namespace momenta
