#include <momenta/dae/gradient/stage_matrix.h>

#include <cmath>

namespace momenta {
namespace {

/// Of the scaled matrix, beside its largest pivot: redundant rows are at what their loops are off
/// by.
constexpr double dependent = 1e-7;
/// Of one without redundant rows: a loop 1e-5 from a singular pose has its square.
constexpr double singular_below = 1e-10;

}  // namespace

StageMatrix::StageMatrix(const Mechanism& mechanism)
    : mechanism_(mechanism),
      nv_(mechanism.nv()),
      m_(mechanism.m()),
      mass_(mechanism.kkt_pattern().mass.size()),
      loops_(mechanism.kkt_pattern().constraint.size()),
      scale_(nv_ + m_) {}

void StageMatrix::factor(Evaluation<double>& e) {
  const KktPattern& pattern = mechanism_.kkt_pattern();
  matrix_.setZero(nv_ + m_, nv_ + m_);
  e.mass_entries(mass_.data());
  for (std::size_t k = 0; k < mass_.size(); ++k) {
    const auto [row, column] = pattern.mass[k];
    matrix_(row, column) = matrix_(column, row) = mass_[k];
  }
  if (m_ > 0) e.constraint_entries(loops_.data());
  const double largest = nv_ > 0 ? matrix_.diagonal().maxCoeff() : 0;
  for (Eigen::Index i = 0; i < nv_; ++i) {
    const double mass = matrix_(i, i);
    scale_[i] = 1 / std::sqrt(mass > 1e-14 * largest ? mass : largest);
  }
  for (std::size_t k = 0; k < loops_.size(); ++k) {
    const auto [row, column] = pattern.constraint[k];
    matrix_(nv_ + row, column) += loops_[k];
  }
  for (Eigen::Index i = 0; i < m_; ++i) {
    const double size =
        matrix_.row(nv_ + i).head(nv_).transpose().cwiseProduct(scale_.head(nv_)).norm();
    scale_[nv_ + i] = size > 0 ? 1 / size : 1;
  }
  matrix_.topRightCorner(nv_, m_) = matrix_.bottomLeftCorner(m_, nv_).transpose();
  matrix_ = scale_.asDiagonal() * matrix_ * scale_.asDiagonal();
  if (rank_ < 0) {
    orthogonal_.setThreshold(dependent);
    orthogonal_.compute(matrix_);
    rank_ = orthogonal_.rank();
  }
  if (rank_ == matrix_.rows()) {
    lu_.compute(matrix_);
    singular_ = matrix_.rows() > 0 && !(lu_.rcond() > singular_below);
  } else {
    orthogonal_.compute(matrix_);
    singular_ = orthogonal_.rank() != rank_;
  }
}

Eigen::MatrixXd StageMatrix::solve(const Eigen::MatrixXd& right) const {
  const Eigen::MatrixXd scaled = scale_.asDiagonal() * right;
  if (rank_ == matrix_.rows()) return scale_.asDiagonal() * lu_.solve(scaled);
  return scale_.asDiagonal() * orthogonal_.solve(scaled);
}

}  // namespace momenta
