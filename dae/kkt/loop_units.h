#pragma once
// Units in which it is counted what joints move and how far loops are open: lengths of the
// scene, and radians. Scaled so, neither depends on the units of the scene.

#include <momenta/dae/loop/left_by_files.h>
#include <momenta/dae/mechanism.h>

#include <Eigen/Core>

namespace momenta {

/// By rate u (nv): the length of the scene, or a radian; of a Lagrangian the largest position at
/// the start of its coordinates in that unit, 1 where these are zero or the unit is that of angles.
Eigen::VectorXd rate_units(const Mechanism& mechanism);

struct LoopUnits {
  explicit LoopUnits(const Mechanism& mechanism);

  Eigen::VectorXd rates;      ///< by rate u, nv [m or rad]
  Eigen::VectorXd equations;  ///< by loop equation, m; of a coupler what its terms are by nature
  /// What rounding leaves open of loops that close, in these units. It grows with the way from the
  /// ground: a sum of k terms of size up to R is off by √k R ε.
  double rounding = 0;
};

}  // namespace momenta
