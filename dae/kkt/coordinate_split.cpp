#include <momenta/dae/kkt/coordinate_split.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace momenta {
namespace {

constexpr double regular_pivot = 1e-9;  // relative to the largest pivot
constexpr int dense_limit = 40;         // rows up to which dense LU is faster than KLU

}  // namespace

CoordinateSplit::CoordinateSplit(std::vector<KktPattern::Entry> pattern, int rows,
                                 Eigen::VectorXd weights)
    : pattern_(std::move(pattern)), weights_(std::move(weights)), row_count_(rows) {}

bool CoordinateSplit::choose(const std::vector<double>& values, int rank) {
  const Eigen::Index columns = weights_.size();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(row_count_, columns);
  for (std::size_t i = 0; i < values.size(); ++i)
    a(pattern_[i].row, pattern_[i].column) = values[i] / weights_[pattern_[i].column];
  if (!a.allFinite()) return false;
  if (a.size() == 0) {  // nothing moves, or nothing ties
    rows_.clear();
    dependent_.clear();
    independent_.resize(static_cast<std::size_t>(columns));
    std::iota(independent_.begin(), independent_.end(), 0);
    return rank <= 0;
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(a);
  const Eigen::VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
  const double least = regular_pivot * (pivots.size() > 0 ? pivots.maxCoeff() : 0);
  const auto found = static_cast<int>((pivots.array() > least).count());
  if (rank < 0) rank = found;
  if (found < rank) return false;
  // P A Q = L U: row i of P A is row p⁻¹(i) of A.
  const Eigen::VectorXi row_of = lu.permutationP().inverse().eval().indices(),
                        column_of = lu.permutationQ().indices();
  rows_.assign(row_of.begin(), row_of.begin() + rank);
  dependent_.assign(column_of.begin(), column_of.begin() + rank);
  independent_.assign(column_of.begin() + rank, column_of.end());
  std::sort(independent_.begin(), independent_.end());
  return true;
}

SplitFactor::SplitFactor(const CoordinateSplit& split)
    : split_(split),
      sparse_(split.rank() > dense_limit),
      right_(split.rank()),
      column_(split.row_count()),
      slopes_(split.rank()) {
  const int n = split.rank();
  std::map<int, int> row_place, column_place;
  for (int k = 0; k < n; ++k) {
    row_place[split.rows()[static_cast<std::size_t>(k)]] = k;
    column_place[split.dependent()[static_cast<std::size_t>(k)]] = k;
  }
  std::map<std::pair<int, int>, int> sorted;  // (column, row) of the block
  for (const auto& entry : split.pattern()) {
    const auto r = row_place.find(entry.row), c = column_place.find(entry.column);
    const bool inside = r != row_place.end() && c != column_place.end();
    place_.push_back(!inside ? -1 : c->second * n + r->second);
    if (inside) sorted[{c->second, r->second}] = 0;
  }
  if (!sparse_) {
    block_ = Eigen::MatrixXd::Zero(n, n);
    lu_ = Eigen::PartialPivLU<Eigen::MatrixXd>(n);
    return;
  }
  start_.assign(static_cast<std::size_t>(n) + 1, 0);
  for (auto& [key, at] : sorted) {
    at = static_cast<int>(row_.size());
    row_.push_back(key.second);
    ++start_[static_cast<std::size_t>(key.first) + 1];
  }
  for (std::size_t j = 1; j < start_.size(); ++j) start_[j] += start_[j - 1];
  for (int& place : place_)
    if (place >= 0) place = sorted.at({place / n, place % n});
  value_.assign(row_.size(), 0.0);
  klu_defaults(&common_);
  symbolic_ = klu_analyze(n, start_.data(), row_.data(), &common_);
}

SplitFactor::~SplitFactor() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
}

bool SplitFactor::factor(const std::vector<double>& values) {
  double* to = sparse_ ? value_.data() : block_.data();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (place_[i] >= 0) to[place_[i]] = values[i];
  if (!sparse_) {
    if (block_.size() > 0) lu_.compute(block_);
    return true;
  }
  // Pivots chosen once serve until the smallest is 1e-8 of the largest.
  if (numeric_ &&
      klu_refactor(start_.data(), row_.data(), value_.data(), symbolic_, numeric_, &common_) == 1 &&
      common_.status == KLU_OK && klu_rcond(symbolic_, numeric_, &common_) == 1 &&
      common_.rcond > 1e-8)
    return true;
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  numeric_ = symbolic_ ? klu_factor(start_.data(), row_.data(), value_.data(), symbolic_, &common_)
                       : nullptr;
  return numeric_ && common_.status == KLU_OK;
}

void SplitFactor::solve(const Eigen::VectorXd& right, Eigen::VectorXd& x) {
  for (Eigen::Index k = 0; k < right_.size(); ++k)
    right_[k] = right[split_.rows()[static_cast<std::size_t>(k)]];
  if (right_.size() == 0) return;
  if (sparse_) {
    x = right_;
    klu_solve(symbolic_, numeric_, split_.rank(), 1, x.data(), &common_);
  } else {
    x.noalias() = lu_.solve(right_);
  }
}

double SplitFactor::growth(const std::vector<double>& values) {
  double largest = 0;
  const auto& weights = split_.weights();
  const auto& pattern = split_.pattern();
  for (const int independent : split_.independent()) {
    column_.setZero();
    for (std::size_t i = 0; i < values.size(); ++i)
      if (pattern[i].column == independent) column_[pattern[i].row] = values[i];
    solve(column_, slopes_);
    for (int k = 0; k < split_.rank(); ++k) {
      const double weighed = std::abs(slopes_[k]) *
                             weights[split_.dependent()[static_cast<std::size_t>(k)]] /
                             weights[independent];
      if (!(weighed <= largest)) largest = weighed;
    }
  }
  return largest;
}

}  // namespace momenta
