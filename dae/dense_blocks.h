#pragma once
// The blocks of (7) as whole matrices, for what asks for all of them at once: singular values,
// ranks, users. After place() of the evaluation; O(n²) memory.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>

namespace momenta {

/// M, nv × nv.
Eigen::MatrixXd dense_mass(const Mechanism& mechanism, Evaluation<double>& e);
/// Φ_q, m × nv.
Eigen::MatrixXd dense_constraints(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
