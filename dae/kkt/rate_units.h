#pragma once
// Units of coordinates: lengths of the scene, and radians.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

/// By rate u (nv), whether its coordinate is a length; of a Lagrangian, whether it has a unit other
/// than that of angles.
std::vector<bool> lengths_by_rate(const Mechanism& mechanism);

/// What a rate u counts as one of (nv): the length of the scene, or a radian; of a Lagrangian the
/// largest position at the start of its coordinates in that unit, 1 where these are zero.
Eigen::VectorXd rate_units(const Mechanism& mechanism);

}  // namespace momenta
