#pragma once
// The matrix of (7) and (3) at a stage, factorised once for all directions:
//
//   ( M    Φ_qᵀ ) ( x )   ( r )
//   ( Φ_q  0    ) ( y ) = ( s ),
//
// scaled to unit diagonal and unit rows. By LU where the rows are independent at the start, sparse
// (KLU, dae/kkt/klu_solver.h) from some tens of unknowns on; else by a complete orthogonal
// decomposition: x is unique, and y is the shortest.

#include <momenta/dae/kkt/klu_solver.h>
#include <momenta/dae/mechanism.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <memory>

namespace momenta {

class StageMatrix {
 public:
  explicit StageMatrix(const Mechanism& mechanism);
  /// At the last place() of the evaluation. Sparse O(entries of the factors), else O((nv + m)³);
  /// the first always.
  void factor(Evaluation<double>& e);
  /// Of right-hand sides, nv + m × any number.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right);
  /// Whether the last one had another rank than the first, at the start: one of both poses is
  /// singular, and no derivative passes it.
  bool singular() const { return singular_; }
  /// The rows are known to be independent at the start, and nothing is decomposed for it.
  void independent() { rank_ = nv_ + m_; }
  /// Dense from now on, whatever the size.
  void dense() { sparse_.reset(); }
  bool is_sparse() const { return sparse_ != nullptr; }

 private:
  void fill_dense();

  const Mechanism& mechanism_;
  Eigen::Index nv_, m_;
  Eigen::Index rank_ = -1;  ///< of the first
  bool singular_ = false;
  bool dense_ = false;                      ///< the last factor() is a dense one
  std::vector<KktPattern::Entry> entries_;  ///< M, then Φ_q below it, one of each place
  std::vector<std::size_t> place_;          ///< of the entries of Φ_q as they are evaluated
  std::vector<double> values_, loops_, soft_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd scale_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal_;
  std::unique_ptr<KluSolver> sparse_;  ///< null: dense
};

}  // namespace momenta
