#pragma once
// The matrix of (7) and (3) at a stage, factorised once for all directions:
//
//   ( M    Φ_qᵀ ) ( x )   ( r )
//   ( Φ_q  0    ) ( y ) = ( s ),
//
// scaled to unit diagonal and unit rows. By LU where the rows are independent at the start, else by
// a complete orthogonal decomposition: x is unique, and y is the shortest.

#include <momenta/dae/mechanism.h>

#include <Eigen/LU>
#include <Eigen/QR>

namespace momenta {

class StageMatrix {
 public:
  explicit StageMatrix(const Mechanism& mechanism);
  /// At the last place() of the evaluation. O((nv + m)³)
  void factor(Evaluation<double>& e);
  /// Of right-hand sides, nv + m × any number.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  /// Whether the last one had another rank than the first, at the start: one of both poses is
  /// singular, and no derivative passes it.
  bool singular() const { return singular_; }

 private:
  const Mechanism& mechanism_;
  Eigen::Index nv_, m_;
  Eigen::Index rank_ = -1;  ///< of the first
  bool singular_ = false;
  std::vector<double> mass_, loops_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd scale_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal_;
};

}  // namespace momenta
