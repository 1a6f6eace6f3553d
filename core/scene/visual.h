#pragma once
// What a body looks like: solids that are drawn and have no effect on motion.

#include <momenta/core/scene/location.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace momenta {

/// A solid to be drawn, fixed in a body or in the ground. It has axes of its own, with its origin
/// at `position` and turned by `rotation`: a point x of the solid is position + rotation · x in
/// body axes. A body may have several; one that has any is drawn by them instead of its `shape`.
struct VisualSpec {
  std::string body;  ///< or "ground"
  std::string kind;  ///< box sphere capsule cylinder ellipsoid mesh
  /// box: x, y, z; sphere: radius, 0, 0; cylinder: length, radius, 0; capsule: length between the
  /// centres of its two ends, radius, 0, both along z; ellipsoid: half axes x, y, z [m]; mesh:
  /// factors on the coordinates of the file
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< body axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< its axes in body axes
  std::optional<Eigen::Vector3d> colour;  ///< red, green, blue from 0 to 1; none: that of bodies
  std::string file;  ///< mesh: path, relative to the folder of the scene's file
  Location at;       ///< where the file has it
};

}  // namespace momenta
