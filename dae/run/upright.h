#pragma once
// The view of a mechanism in a plane.

#include <Eigen/Core>

namespace momenta {

/// Columns right, up and towards the viewer, in ground axes, of the plane with this basis, normal
/// last. Gravity acts downwards: in a plane of two ground axes up is the one most opposed to
/// gravity, or without gravity z, or y in the plane of x and y; in a skew plane up is against
/// gravity. Right is the side on which its largest component is positive. A skew plane without
/// gravity keeps its basis.
Eigen::Matrix3d upright(const Eigen::Matrix3d& basis, const Eigen::Vector3d& gravity);

}  // namespace momenta
