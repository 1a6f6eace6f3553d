#include <momenta/dae/gradient/stage_matrix.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {
namespace {

using Eigen::Index;

/// Relative pivot of a redundant row in the scaled matrix: the error of its loop.
constexpr double dependent = 1e-7;
/// Least reciprocal condition otherwise: a loop 1e-5 from a singular pose has its square.
constexpr double singular_below = 1e-10;
/// Unknowns from which on the sparse factors take less time.
constexpr Index sparse_from = 40;

}  // namespace

StageMatrix::StageMatrix(const Mechanism& mechanism)
    : mechanism_(mechanism),
      nv_(mechanism.nv()),
      m_(mechanism.m()),
      entries_(mechanism.kkt_pattern().mass),
      loops_(mechanism.kkt_pattern().constraint.size()),
      soft_(static_cast<std::size_t>(m_), 0.0),
      scale_(nv_ + m_) {
  std::map<std::pair<int, int>, std::size_t> known;
  for (const auto& e : mechanism.kkt_pattern().constraint) {
    const auto [at, is_new] = known.try_emplace({e.row, e.column}, entries_.size());
    if (is_new) entries_.push_back({static_cast<int>(nv_) + e.row, e.column});
    place_.push_back(at->second);
  }
  values_.resize(entries_.size());
  if (m_ > 0 && nv_ + m_ >= sparse_from)
    sparse_ = std::make_unique<KluSolver>(static_cast<int>(nv_ + m_), static_cast<int>(m_),
                                          entries_, KluSolver::Order::blocks);
}

void StageMatrix::fill_dense() {
  matrix_.setZero(nv_ + m_, nv_ + m_);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const auto [row, column] = entries_[k];
    matrix_(row, column) = matrix_(column, row) = values_[k];
  }
}

void StageMatrix::factor(Evaluation<double>& e) {
  if (nv_ + m_ == 0) return;
  const std::size_t masses = mechanism_.kkt_pattern().mass.size();
  e.mass_entries(values_.data());
  if (m_ > 0) e.constraint_entries(loops_.data());
  std::fill(values_.begin() + static_cast<std::ptrdiff_t>(masses), values_.end(), 0.0);
  for (std::size_t k = 0; k < loops_.size(); ++k) values_[place_[k]] += loops_[k];
  scale_.setZero();
  for (std::size_t k = 0; k < masses; ++k)
    if (entries_[k].row == entries_[k].column) scale_[entries_[k].row] = values_[k];
  const double largest = nv_ > 0 ? scale_.head(nv_).maxCoeff() : 0;
  for (Index i = 0; i < nv_; ++i)
    scale_[i] = 1 / std::sqrt(scale_[i] > 1e-14 * largest ? scale_[i] : largest);
  for (std::size_t k = masses; k < entries_.size(); ++k) {
    const double entry = values_[k] * scale_[entries_[k].column];
    scale_[entries_[k].row] += entry * entry;
  }
  for (Index i = nv_; i < nv_ + m_; ++i) scale_[i] = scale_[i] > 0 ? 1 / std::sqrt(scale_[i]) : 1;
  for (std::size_t k = 0; k < entries_.size(); ++k)
    values_[k] *= scale_[entries_[k].row] * scale_[entries_[k].column];
  if (rank_ < 0) {
    fill_dense();
    orthogonal_.setThreshold(dependent);
    orthogonal_.compute(matrix_);
    rank_ = orthogonal_.rank();
  }
  dense_ = true;
  if (rank_ != nv_ + m_) {
    fill_dense();
    orthogonal_.compute(matrix_);
    singular_ = orthogonal_.rank() != rank_;
    return;
  }
  if (sparse_) {
    for (std::size_t k = 0; k < values_.size(); ++k) sparse_->matrix().set(k, values_[k]);
    dense_ = !sparse_->factor(soft_) || !(sparse_->pivot_ratio() > singular_below);
    singular_ = false;
    if (!dense_) return;
    // Pivots chosen for sparsity may be small though the matrix is regular.
  }
  fill_dense();
  lu_.compute(matrix_);
  singular_ = matrix_.rows() > 0 && !(lu_.rcond() > singular_below);
}

Eigen::MatrixXd StageMatrix::solve(const Eigen::MatrixXd& right) {
  if (nv_ + m_ == 0) return right;
  Eigen::MatrixXd x = scale_.asDiagonal() * right;
  if (!dense_) {
    for (Index j = 0; j < x.cols() && !dense_; ++j)
      if (!sparse_->solve(x.col(j).data(), nullptr, true)) dense_ = true;
    if (!dense_) return scale_.asDiagonal() * x;
    // A residual did not come down to rounding.
    x = scale_.asDiagonal() * right;
    fill_dense();
    lu_.compute(matrix_);
  }
  if (rank_ == nv_ + m_) return scale_.asDiagonal() * lu_.solve(x);
  return scale_.asDiagonal() * orthogonal_.solve(x);
}

}  // namespace momenta
