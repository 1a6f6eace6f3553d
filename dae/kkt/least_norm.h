#pragma once
// Least changes that meet linear equations, A x = b with A m × n, rows possibly dependent:
//
//   x = A⁺ b,     or damped   min |A x − b|² + λ² |x|².
//
// Few entries: complete orthogonal decomposition, and Householder's QR of ( A; λ 1 ). Many: sparse
// QR of Aᵀ, from ( A  λ1 )ᵀ Π = Q R: x is the upper part of Q R⁻ᵀ Πᵀ b, the shortest ( x, y ) with
// A x + λ y = b; its cost goes with the fill of m columns, whatever n is. Dependent rows are those
// whose column of R is below rank_tolerance (loop_rank.h) of the largest column of Aᵀ; then A x = b
// is met in the others.
// Source: Davis, Algorithm 915, SuiteSparseQR, ACM TOMS 38 (2011) 8.

#include <momenta/dae/kkt/loop_rank.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

class LeastNorm {
 public:
  /// Places of the entries of A, which must outlive this.
  LeastNorm(const std::vector<KktPattern::Entry>& pattern, int rows, int columns);
  ~LeastNorm();
  LeastNorm(const LeastNorm&) = delete;
  LeastNorm& operator=(const LeastNorm&) = delete;

  /// Factorises A from its entries; `damping` λ, 0: none. Sparse A: free where neither has changed.
  void factor(const std::vector<double>& values, double damping = 0);
  Eigen::VectorXd solve(const Eigen::VectorXd& b);
  /// A x
  Eigen::VectorXd product(const std::vector<double>& values, const Eigen::VectorXd& x) const;

  /// Rows of A that follow from the others, and the number that do not; `least`, for dense A: see
  /// loop_rank().
  LoopRank judge(const std::vector<double>& values, Judged judged = Judged::singular_values,
                 double least = 0);
  /// Number of sparse factorisations.
  long factorizations() const;
  bool is_dense() const { return sparse_ == nullptr; }

 private:
  struct Dense;
  struct Sparse;
  const std::vector<KktPattern::Entry>& pattern_;
  int rows_, columns_;
  std::unique_ptr<Dense> dense_;
  std::unique_ptr<Sparse> sparse_;
};

}  // namespace momenta
