#include <momenta/core/format/mjcf/mjcf_frames.h>
#include <momenta/core/scene/kinds.h>

#include <cmath>

namespace momenta::reading {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Turn = Eigen::AngleAxisd;

Quaterniond from_quaternion(const Node& node) {
  const std::vector<double> wxyz = node.numbers("quat", 4);
  const Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!(q.norm() > 0)) node.fail("quat", "is zero, expected a quaternion w x y z");
  return is_unit(q) ? q : q.normalized();
}

Quaterniond from_axis_and_angle(const Node& node, const MjcfAngles& angles) {
  const std::vector<double> x = node.numbers("axisangle", 4);
  const Vector3d axis(x[0], x[1], x[2]);
  if (!(axis.norm() > 0)) node.fail("axisangle", "has a zero axis, expected a direction");
  return Quaterniond(Turn(x[3] * angles.unit, axis.normalized()));
}

/// `xyaxes`: y is made perpendicular to x.
Quaterniond from_x_and_y(const Node& node) {
  const std::vector<double> n = node.numbers("xyaxes", 6);
  Eigen::Matrix3d axes;
  const Vector3d x = Vector3d(n[0], n[1], n[2]).normalized();
  const Vector3d given(n[3], n[4], n[5]);
  const Vector3d y = given - given.dot(x) * x;
  if (!(y.norm() > parallel_slack * given.norm()) || !(x.norm() > 0))
    node.fail("xyaxes", "has no two directions, expected two that are not parallel");
  axes << x, y.normalized(), x.cross(y.normalized());
  return Quaterniond(axes).normalized();
}

/// The shortest turn of z to a direction; about x where it is opposite.
Quaterniond z_to(const Vector3d& direction) {
  const Vector3d across = Vector3d::UnitZ().cross(direction);
  const double angle = std::atan2(across.norm(), direction.z());
  return Quaterniond(
      Turn(angle, across.norm() > 0 ? Vector3d(across.normalized()) : Vector3d(Vector3d::UnitX())));
}

}  // namespace

Quaterniond turn_by_euler(const Vector3d& euler, const MjcfAngles& angles) {
  const Vector3d e = angles.unit * euler;
  Quaterniond turn = Quaterniond::Identity();
  for (int i = 0; i < 3; ++i) {
    const char letter = angles.euler_order[static_cast<std::size_t>(i)];
    const bool fixed = letter < 'a';
    const Quaterniond one(Turn(e[i], Vector3d::Unit(letter - (fixed ? 'X' : 'x'))));
    turn = fixed ? one * turn : turn * one;
  }
  return turn;
}

Quaterniond read_turn(const Node& node, const MjcfAngles& angles) {
  std::string_view way;
  for (const std::string_view key : orientation_keys) {
    if (!node.has(key)) continue;
    if (!way.empty())
      node.fail("has " + std::string(way) + " and " + std::string(key) +
                ", expected one orientation");
    way = key;
  }
  if (way == "quat") return from_quaternion(node);
  if (way == "axisangle") return from_axis_and_angle(node, angles);
  if (way == "xyaxes") return from_x_and_y(node);
  if (way == "zaxis") return z_to(node.direction("zaxis", Vector3d::UnitZ()));
  if (way == "euler") return turn_by_euler(node.vector("euler"), angles);
  return Quaterniond::Identity();
}

MjcfFrame read_frame(const Node& node, const MjcfAngles& angles) {
  if (!node.has("fromto")) return {node.vector("pos", Vector3d::Zero()), read_turn(node, angles)};
  const std::vector<double> n = node.numbers("fromto", 6);
  const Vector3d from(n[0], n[1], n[2]), to(n[3], n[4], n[5]);
  if (from == to) node.fail("fromto", "has the same point twice, expected two");
  return {0.5 * (from + to), z_to((from - to).normalized())};
}

}  // namespace momenta::reading
