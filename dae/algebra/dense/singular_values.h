#pragma once
// Singular values of dense matrices: Eigen's divide and conquer, which (3.4) errs on some with many
// singular values that are zero, up to NaN and to reading out of bounds. So QR with pivots takes
// these off, A P = Q (R; 0) and Rᵀ = Z (Lᵀ; 0): values that are rounding are zero, and L is
// regular. Where the product is another matrix all the same, the rotations of Jacobi serve. Half a
// minute of compilation, once.

#include <Eigen/SVD>

namespace momenta {

/// A = U S Vᵀ, m × n.
struct SingularValues {
  SingularValues() = default;
  /// `options` of Eigen say which columns of U and V there are: all, or as many as values. Where A
  /// is not finite, nothing is. O((m + n)³)
  explicit SingularValues(const Eigen::MatrixXd& a,
                          unsigned options = Eigen::ComputeFullU | Eigen::ComputeFullV);

  /// Number of values above this part of the largest.
  Eigen::Index rank(double part) const;
  /// The least x (n) with the least |A x − b|, by `rank` values. O(rank (m + n))
  Eigen::VectorXd solve(const Eigen::VectorXd& b, Eigen::Index rank) const;

  Eigen::VectorXd values;  ///< descending
  Eigen::MatrixXd u, v;    ///< orthonormal columns
};

}  // namespace momenta

extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
