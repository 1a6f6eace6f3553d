#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/kkt/least_norm.h>
#include <suitesparse/SuiteSparseQR.hpp>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace momenta {
namespace {

/// Entries of A, zeros included, and columns up to which it is dense: damped, the dense way costs
/// the cube of columns, however few rows there are.
constexpr double most_dense = 1e5;
constexpr int most_dense_columns = 400;

using Eigen::MatrixXd;
using Eigen::VectorXd;
}  // namespace

struct LeastNorm::Dense {
  DenseLeastSquares factors;
  bool is_damped = false;
};

/// ( A  λ1 )ᵀ by columns, and its factors.
struct LeastNorm::Sparse {
  using Long = SuiteSparse_long;
  using Factors = SuiteSparseQR_factorization<double>;

  Sparse() { cholmod_l_start(&common); }
  ~Sparse() {
    forget();
    cholmod_l_finish(&common);
  }
  Sparse(const Sparse&) = delete;
  Sparse& operator=(const Sparse&) = delete;
  void forget() {
    if (factors != nullptr) SuiteSparseQR_free<double>(&factors, &common);
  }

  /// Columns of Aᵀ, the rows of A, with λ below them.
  void fill(const std::vector<KktPattern::Entry>& pattern, const std::vector<double>& values,
            std::size_t m, std::size_t n, double damping) {
    start.assign(m + 1, 0);
    for (const auto& e : pattern) ++start[static_cast<std::size_t>(e.row) + 1];
    for (std::size_t i = 0; i < m; ++i) start[i + 1] += start[i] + (damping > 0 ? 1 : 0);
    index.resize(static_cast<std::size_t>(start[m]));
    value.resize(index.size());
    std::vector<Long> next(start.begin(), start.end() - 1);
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(pattern[k].row)]++);
      index[at] = pattern[k].column;
      value[at] = values[k];
    }
    for (std::size_t i = 0; damping > 0 && i < m; ++i) {
      const auto at = static_cast<std::size_t>(next[i]);
      index[at] = static_cast<Long>(n + i);
      value[at] = damping;
    }
    matrix = {};
    matrix.nrow = damping > 0 ? n + m : n;
    matrix.ncol = m;
    matrix.nzmax = index.size();
    matrix.p = start.data();
    matrix.i = index.data();
    matrix.x = value.data();
    matrix.itype = CHOLMOD_LONG;
    matrix.xtype = CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.packed = 1;
  }
  void factorise(double tolerance) {
    forget();
    ++factorizations;
    factors = SuiteSparseQR_factorize<double>(SPQR_ORDERING_DEFAULT, tolerance, &matrix, &common);
    if (factors == nullptr) throw std::bad_alloc();
  }
  double largest_column() const {
    double largest = 0;
    for (std::size_t j = 0; j + 1 < start.size(); ++j) {
      double sum = 0;
      for (auto k = static_cast<std::size_t>(start[j]); k < static_cast<std::size_t>(start[j + 1]);
           ++k)
        sum += value[k] * value[k];
      largest = std::max(largest, sum);
    }
    return std::sqrt(largest);
  }
  /// A vector of SuiteSparse's, freed.
  struct Owned {
    cholmod_dense* x;
    cholmod_common& common;
    ~Owned() { cholmod_l_free_dense(&x, &common); }
  };

  cholmod_common common{};
  cholmod_sparse matrix{};
  std::vector<Long> start, index;
  std::vector<double> value;
  std::vector<double> factored;  ///< the values of A in the factors
  double factored_damping = 0;   ///< the λ of the factors
  Factors* factors = nullptr;
  long factorizations = 0;
};

LeastNorm::LeastNorm(const std::vector<KktPattern::Entry>& pattern, int rows, int columns)
    : pattern_(pattern), rows_(rows), columns_(columns) {
  if (static_cast<double>(rows) * columns <= most_dense && columns <= most_dense_columns)
    dense_ = std::make_unique<Dense>();
  else
    sparse_ = std::make_unique<Sparse>();
}
LeastNorm::~LeastNorm() = default;

long LeastNorm::factorizations() const {
  return sparse_ ? sparse_->factorizations : 0;
}

namespace {

MatrixXd filled(const std::vector<KktPattern::Entry>& pattern, const std::vector<double>& values,
                int rows, int columns) {
  MatrixXd a = MatrixXd::Zero(rows, columns);
  for (std::size_t k = 0; k < values.size(); ++k) a(pattern[k].row, pattern[k].column) = values[k];
  return a;
}

}  // namespace

void LeastNorm::factor(const std::vector<double>& values, double damping) {
  if (sparse_) {
    if (sparse_->factors != nullptr && values == sparse_->factored &&
        damping == sparse_->factored_damping)
      return;
    sparse_->factored = values;
    sparse_->factored_damping = damping;
    sparse_->fill(pattern_, values, static_cast<std::size_t>(rows_),
                  static_cast<std::size_t>(columns_), damping);
    sparse_->factorise(rank_tolerance * sparse_->largest_column());
    return;
  }
  const MatrixXd a = filled(pattern_, values, rows_, columns_);
  dense_->is_damped = damping > 0;
  if (damping > 0) {
    MatrixXd stacked(rows_ + columns_, columns_);
    stacked << a, damping * MatrixXd::Identity(columns_, columns_);
    dense_->factors.compute_full_rank(stacked);
  } else {
    dense_->factors.compute(a, rank_tolerance);
  }
}

VectorXd LeastNorm::solve(const VectorXd& b) {
  if (dense_) {
    if (!dense_->is_damped) return dense_->factors.solve(b);
    VectorXd right = VectorXd::Zero(rows_ + columns_);
    right.head(rows_) = b;
    return dense_->factors.solve(right);
  }
  Sparse& s = *sparse_;
  cholmod_dense right{};
  VectorXd copy = b;
  right.nrow = right.nzmax = right.d = static_cast<std::size_t>(rows_);
  right.ncol = 1;
  right.x = copy.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  const Sparse::Owned y{
      SuiteSparseQR_solve<double>(SPQR_RTX_EQUALS_ETB, s.factors, &right, &s.common), s.common};
  if (y.x == nullptr) throw std::bad_alloc();
  const Sparse::Owned x{SuiteSparseQR_qmult<double>(SPQR_QX, s.factors, y.x, &s.common), s.common};
  if (x.x == nullptr) throw std::bad_alloc();
  return Eigen::Map<const VectorXd>(static_cast<const double*>(x.x->x), columns_);
}

VectorXd LeastNorm::product(const std::vector<double>& values, const VectorXd& x) const {
  VectorXd b = VectorXd::Zero(rows_);
  for (std::size_t k = 0; k < values.size(); ++k)
    b[pattern_[k].row] += values[k] * x[pattern_[k].column];
  return b;
}

namespace {

/// Whether no column of a pivoted QR factorisation of Aᵀ comes near the border: the least singular
/// value is not far below the last pivot (the bound of theory, 2^m below, no linkage comes near).
bool clearly_independent(const MatrixXd& a) {
  constexpr double clear = 1e4 * rank_tolerance;
  if (a.rows() > a.cols()) return false;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(a.transpose());
  const VectorXd pivots = qr.matrixR().diagonal().cwiseAbs();
  return pivots[a.rows() - 1] > clear * pivots[0];
}

}  // namespace

LoopRank LeastNorm::judge(const std::vector<double>& values, Judged judged, double least) {
  LoopRank rows;
  if (!all_finite(values)) return rows;
  if (dense_) {
    const MatrixXd a = filled(pattern_, values, rows_, columns_);
    if (judged == Judged::dependence && rows_ > 0 && clearly_independent(a)) {
      rows.rank = rows_;
      return rows;
    }
    RankAndIdle all = rank_and_idle(a, 0, -1, least);
    rows.rank = all.rank;
    rows.kept = all.kept;
    rows.dropped = all.dropped;
    rows.singular_values = std::move(all.singular_values);
    rows.dependent = reduce(all.left);
  } else {
    factor(values);
    const auto* f = sparse_->factors;
    rows.rank = static_cast<int>(f->rank);
    for (int i = 0; f->Rmap != nullptr && i < rows_; ++i)
      if (f->Rmap[i] >= f->rank)
        rows.dependent.push_back(f->Q1fill == nullptr ? i : static_cast<int>(f->Q1fill[i]));
  }
  std::sort(rows.dependent.begin(), rows.dependent.end());
  return rows;
}

}  // namespace momenta
