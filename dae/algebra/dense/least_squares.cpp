#include <momenta/dae/algebra/dense/least_squares.h>

#include <Eigen/QR>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct DenseLeastSquares::Factors {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> complete;
  Eigen::HouseholderQR<MatrixXd> of_full_rank;
  bool full_rank = false;
};

DenseLeastSquares::DenseLeastSquares() : factors_(std::make_unique<Factors>()) {}
DenseLeastSquares::~DenseLeastSquares() = default;

void DenseLeastSquares::compute(const MatrixXd& a, double threshold) {
  factors_->complete.setThreshold(threshold);
  factors_->complete.compute(a);
  factors_->full_rank = false;
}

void DenseLeastSquares::compute(const MatrixXd& a) {
  factors_->complete.setThreshold(Eigen::Default);
  factors_->complete.compute(a);
  factors_->full_rank = false;
}

void DenseLeastSquares::compute_full_rank(const MatrixXd& a) {
  factors_->of_full_rank.compute(a);
  factors_->full_rank = true;
}

MatrixXd DenseLeastSquares::solve(const MatrixXd& b) const {
  return factors_->full_rank ? MatrixXd(factors_->of_full_rank.solve(b))
                             : MatrixXd(factors_->complete.solve(b));
}

VectorXd DenseLeastSquares::solve(const VectorXd& b) const {
  return factors_->full_rank ? VectorXd(factors_->of_full_rank.solve(b))
                             : VectorXd(factors_->complete.solve(b));
}

MatrixXd orthogonal_factor(const MatrixXd& a) {
  return Eigen::HouseholderQR<MatrixXd>(a).householderQ();
}

MatrixXd left_null_space(const MatrixXd& a, double pivot) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(a);
  const Eigen::Index rank = (qr.matrixQR().diagonal().array().abs() > pivot).count();
  return MatrixXd(qr.householderQ()).rightCols(a.rows() - rank);
}

}  // namespace momenta
