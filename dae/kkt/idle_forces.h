#pragma once
// Forces of the loops that move nothing, Φ_qᵀν = 0: λ and σ are determined but for these, and where
// there are none the equations of the loops are independent. Judged on a matrix without units,
//
//   A = D^(−1/2) Φ_q diag(M)^(−1/2)
//
// D the scale of each row's group (axis_scale.h), so that turning the axes of a loop changes
// nothing. Singular values above 1e-7 of the largest count: where |Φ| is at rounding level that of
// a redundant row stays below 1e-12, and bodies 10¹² times apart in mass leave 1e-6.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>

namespace momenta {

struct ScaledJacobian {
  Eigen::MatrixXd a;           ///< A, m × nv
  Eigen::VectorXd row_factor;  ///< D^(−1/2), m
};
/// At the configuration placed in `e`. O(m nv)
ScaledJacobian scaled_jacobian(const Mechanism& mechanism, Evaluation<double>& e);

struct RankAndIdle {
  int rank = 0;
  double kept = 0;       ///< smallest singular value that counts
  double dropped = 0;    ///< largest that does not; 0 where all count
  Eigen::MatrixXd left;  ///< null space of Aᵀ, columns
};
/// `largest`: singular value that others are compared with; 0: the largest of `a` itself.
/// O((m + nv)³)
RankAndIdle rank_and_idle(const Eigen::MatrixXd& a, double largest = 0);

/// Forces of the loops (m × n, independent columns) that move nothing at (t, q): Φ_qᵀν = 0. None
/// where the equations are independent. O((m + nv)³)
Eigen::MatrixXd idle_forces(const Mechanism& mechanism, double t, const Eigen::VectorXd& q);

}  // namespace momenta
