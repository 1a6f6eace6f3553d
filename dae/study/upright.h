#pragma once
// How a mechanism in a plane is looked at.

#include <Eigen/Core>

namespace momenta {

/// Columns right, up and towards the viewer, in ground axes, of the plane with this basis, whose
/// last column is its normal. Gravity acts downwards: in a plane of two ground axes up is the one
/// that gravity acts along most, with the sign that makes it so, and where no gravity acts z, or y
/// in the plane of x and y; in a skew plane up is against gravity. Right is the side on which its
/// largest component is positive. A skew plane without gravity keeps its basis.
Eigen::Matrix3d upright(const Eigen::Matrix3d& basis, const Eigen::Vector3d& gravity);

}  // namespace momenta
