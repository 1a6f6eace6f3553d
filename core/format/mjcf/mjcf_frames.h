#pragma once
// Frames of MJCF: a position, and an orientation in one of five notations.

#include <momenta/core/format/xml/xml_node.h>

#include <Eigen/Geometry>
#include <array>
#include <numbers>
#include <string>
#include <string_view>

namespace momenta::reading {

inline constexpr std::array<std::string_view, 5> orientation_keys{"quat", "axisangle", "xyaxes",
                                                                  "zaxis", "euler"};

/// Angles in <compiler>.
struct MjcfAngles {
  double unit = std::numbers::pi / 180;  ///< unit of written angles [rad]; default: degrees
  std::string euler_order = "xyz";  ///< lower case: about the turned axes; upper case: the fixed
};

struct MjcfFrame {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return at + turn * point; }
  MjcfFrame operator*(const MjcfFrame& inner) const {
    return {*this * inner.at, (turn * inner.turn).normalized()};
  }
  MjcfFrame inverse() const { return {-(turn.conjugate() * at), turn.conjugate()}; }
};

/// The turn by three angles, as written, about the axes of `euler_order`.
Eigen::Quaterniond turn_by_euler(const Eigen::Vector3d& euler, const MjcfAngles& angles);
/// The orientation of an element, else none. @throws SceneError where it has two
Eigen::Quaterniond read_turn(const Node& node, const MjcfAngles& angles);
/// `pos` and orientation; or, from `fromto`, the middle of two points with z along them.
MjcfFrame read_frame(const Node& node, const MjcfAngles& angles);

}  // namespace momenta::reading
