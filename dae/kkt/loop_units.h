#pragma once
// Units of rates and of loop equations: lengths of the scene, and radians. Scaled so, neither
// depends on the units of the scene.

#include <momenta/dae/mechanism/loop/left_by_files.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

/// Unit of each rate u (nv): the length of the scene, or a radian; for a Lagrangian the largest
/// start of the coordinates that share a unit, 1 where these are zero or angles.
Eigen::VectorXd rate_units(const Mechanism& mechanism);

struct LoopUnits {
  explicit LoopUnits(const Mechanism& mechanism);

  Eigen::VectorXd rates;      ///< by rate u, nv [m or rad]
  Eigen::VectorXd equations;  ///< by loop equation, m; of a coupler the natural size of its terms
  /// Gap that rounding leaves in closed loops, in these units. It grows with the way from the
  /// ground: a sum of k terms of size up to R is off by √k R ε.
  double rounding = 0;
};

/// Scale of each row of Φ_q M⁻¹ Φ_qᵀ (m) at the configuration placed in `e`: the mean of Σ_j Φ_ij²
/// / M_jj over its group, since a row may vanish in every entry; the natural one where a whole
/// group of axis rows does; the largest for rows that nothing moves. [1/kg, or 1/(kg m²)]
std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
