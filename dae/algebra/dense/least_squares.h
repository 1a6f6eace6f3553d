#pragma once
// Least squares with dense matrices: Eigen's complete orthogonal decomposition and Householder QR,
// which every file that names them compiles for a quarter of a minute, compiled once.

#include <Eigen/Core>
#include <memory>

namespace momenta {

class DenseLeastSquares {
 public:
  DenseLeastSquares();
  ~DenseLeastSquares();

  /// Factorises A (m × n), A P = Q (R 0; 0 0) Z; pivots below `threshold` of the largest count as
  /// zero. O(m n min(m, n)).
  void compute(const Eigen::MatrixXd& a, double threshold);
  /// The same with Eigen's own threshold, min(m, n) ε.
  void compute(const Eigen::MatrixXd& a);
  /// Factorises A of full column rank, m ≥ n: A = Q R.
  void compute_full_rank(const Eigen::MatrixXd& a);

  /// The x of least |x| among those of least |A x − b|, for each column b.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

/// Q (m × m) of the Householder QR of A (m × n): its first columns span those of A.
Eigen::MatrixXd orthogonal_factor(const Eigen::MatrixXd& a);
/// Orthonormal columns that Aᵀ maps to no more than `pivot` each, from QR with column pivots.
Eigen::MatrixXd left_null_space(const Eigen::MatrixXd& a, double pivot);

}  // namespace momenta
