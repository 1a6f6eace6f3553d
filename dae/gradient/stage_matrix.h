#pragma once
// The matrix of (7) and (3) at a stage, factorised once for all directions:
//
//   ( M    Φ_qᵀ ) ( x )   ( r )
//   ( Φ_q  0    ) ( y ) = ( s ),
//
// scaled to unit diagonal and unit rows. By LU where the rows are independent at the start, sparse
// (KLU, dae/kkt/klu_solver.h) from some tens of unknowns on; else by a complete orthogonal
// decomposition: x is unique, y the shortest.

#include <momenta/dae/kkt/klu_solver.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <memory>

namespace momenta {

class StageMatrix {
 public:
  explicit StageMatrix(const Mechanism& mechanism);
  /// Factorises at the last place() of the evaluation. Sparse O(entries of the factors), else, and
  /// at first, O((nv + m)³).
  void factor(Evaluation<double>& e);
  /// Solutions for right-hand sides, nv + m × any number.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right);
  /// Whether the last matrix had another rank than the first, at the start: one pose is singular,
  /// and no derivative passes it.
  bool singular() const { return singular_; }
  /// The rows are independent at the start; spares a decomposition.
  void independent() { rank_ = nv_ + m_; }
  /// Dense factors from now on.
  void dense() { sparse_.reset(); }
  bool is_sparse() const { return sparse_ != nullptr; }

 private:
  void fill_dense();

  const Mechanism& mechanism_;
  Eigen::Index nv_, m_;
  Eigen::Index rank_ = -1;  ///< rank of the first matrix
  bool singular_ = false;
  bool dense_ = false;                      ///< the last factor() was dense
  std::vector<KktPattern::Entry> entries_;  ///< M, then Φ_q below it, one for each place
  std::vector<std::size_t> place_;          ///< places of the entries of Φ_q, in order of
                                            ///< evaluation
  std::vector<double> values_, loops_, soft_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd scale_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal_;
  std::unique_ptr<KluSolver> sparse_;  ///< null: dense
};

}  // namespace momenta
