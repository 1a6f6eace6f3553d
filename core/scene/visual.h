#pragma once
// Solids that draw a body, without effect on motion.

#include <momenta/core/scene/location.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace momenta {

/// A solid to draw, fixed in a body or in the ground: its point x is at position + rotation · x in
/// body axes. It replaces the body's `shape` in drawings.
struct VisualSpec {
  std::string body;  ///< or "ground"
  std::string kind;  ///< box sphere capsule cylinder ellipsoid mesh
  /// box: x, y, z; sphere: radius, 0, 0; cylinder: length, radius, 0; capsule: length between the
  /// centres of its two ends, radius, 0, both along z; ellipsoid: half axes x, y, z [m]; mesh:
  /// factors on the file's coordinates
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< body axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< its axes in body axes
  std::optional<Eigen::Vector3d>
      colour;        ///< red, green, blue from 0 to 1; none: the bodies' colour
  std::string file;  ///< mesh: path, relative to the folder of the scene's file
  Location at;       ///< where the file has it
};

}  // namespace momenta
