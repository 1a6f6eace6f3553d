#pragma once
// A body of a scene, and the solid that draws and weighs it.

#include <momenta/core/scene/location.h>

#include <Eigen/Core>
#include <string>

namespace momenta {

/// A solid of uniform density. It draws a body, and gives `com` and `inertia` each where these are
/// not written out. A rod is slender and reaches from the body origin along its axis, its centre of
/// mass half way. The other shapes are centred on `com` where that is given, else on the body
/// origin. A point has no inertia.
struct Shape {
  std::string kind;  ///< rod box cylinder sphere point, or empty
  /// rod: length, 0, 0; box: x, y, z; cylinder: length, radius, 0; sphere: radius, 0, 0 [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< rod, cylinder: direction in body axes
};

/// A rigid body.
///
/// In a file, inertia is [xx, yy, zz, xy, xz, yz], or [xx, yy, zz], or one number: the moment about
/// z of a planar body, stored as that of a thin plate, diag(Izz/2, Izz/2, Izz). (No body has
/// diag(0, 0, Izz): no principal moment exceeds the sum of the others. Ixx and Iyy have no effect
/// in the plane.) A body with a mass has a shape or an inertia.
struct BodySpec {
  std::string name;                               ///< any but "ground"
  double mass = 0;                                ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< centre of mass in body axes [m]
  /// About the centre of mass, body axes [kg m²]; its principal moments a ≤ b ≤ c satisfy
  /// 0 ≤ a and c ≤ a + b.
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  /// The inertia is taken as it is, even if no rigid body can have it, as in some robot files.
  bool any_inertia = false;
  Shape shape;  ///< draws the body; gives com and inertia where these are not written
  Location at;  ///< where the file has it
};

}  // namespace momenta
