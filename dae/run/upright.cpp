#include <momenta/dae/run/upright.h>

#include <cmath>

namespace momenta {
namespace {

using Eigen::Vector3d;

/// The largest component, with its sign, in its place.
Vector3d largest_part(const Vector3d& v) {
  Eigen::Index axis;
  v.cwiseAbs().maxCoeff(&axis);
  return v[axis] * Vector3d::Unit(axis);
}

}  // namespace

Eigen::Matrix3d upright(const Eigen::Matrix3d& basis, const Vector3d& gravity) {
  const Vector3d normal = basis.col(2);
  const Vector3d down = gravity - normal.dot(gravity) * normal;
  const bool acts = down.norm() > 1e-9 * gravity.norm();
  const bool of_axes =
      largest_part(normal).isApprox(normal) && largest_part(basis.col(0)).isApprox(basis.col(0));
  if (!acts && !of_axes) return basis;
  Vector3d up = -down;
  if (!acts)
    up = std::abs(normal.z()) > 0.5 ? Vector3d::UnitY() : Vector3d::UnitZ();
  else if (of_axes)
    up = largest_part(up);
  up.normalize();
  Vector3d right = up.cross(normal);
  if (largest_part(right).sum() < 0) right = -right;
  Eigen::Matrix3d view;
  view << right, up, right.cross(up);
  return view;
}

}  // namespace momenta
