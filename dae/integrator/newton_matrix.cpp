// Dense: Eigen's partially pivoted LU. Sparse: KLU, its ordering once, its pivots kept from
// factorisation to factorisation as long as they do not make the entries grow.
// Source of KLU: Davis, Palamadai Natarajan, ACM TOMS 37 (2010) 36.

#include <klu.h>
#include <momenta/dae/integrator/newton_matrix.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace momenta {
namespace {

template <class Scalar>
class DenseMatrix final : public NewtonMatrix<Scalar> {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

 public:
  explicit DenseMatrix(int size) : a_(Matrix::Zero(size, size)), lu_(size), x_(size) {}
  Scalar* values() override { return a_.data(); }
  bool factor() override {
    ++choices_;
    lu_.compute(a_);
    for (Eigen::Index i = 0; i < a_.rows(); ++i) {
      const double pivot = std::abs(lu_.matrixLU()(i, i));
      if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    }
    return true;
  }
  long choices() const override { return choices_; }
  void solve(Scalar* b) override {
    Eigen::Map<Vector> right(b, a_.rows());
    x_.noalias() = lu_.permutationP() * right;
    lu_.matrixLU().template triangularView<Eigen::UnitLower>().solveInPlace(x_);
    lu_.matrixLU().template triangularView<Eigen::Upper>().solveInPlace(x_);
    right = x_;
  }

 private:
  Matrix a_;
  Eigen::PartialPivLU<Matrix> lu_;
  Vector x_;
  long choices_ = 0;
};

/// Old pivots are given up where entries grow on them by more than `most_growth` and by
/// `beside_fresh` times more than on fresh ones: local matrices of long ladders grow by 10⁶ on any.
constexpr double most_growth = 1e4, beside_fresh = 100;

template <class Scalar>
class SparseMatrix final : public NewtonMatrix<Scalar> {
  static constexpr bool is_real = std::is_same_v<Scalar, double>;

 public:
  enum class Order { blocks, columns };  ///< BTF and AMD, or COLAMD alone
  SparseMatrix(int size, const JacobianPattern& pattern, Order order = Order::blocks)
      : size_(size),
        column_start_(pattern.column_start.begin(), pattern.column_start.end()),
        row_(pattern.row.begin(), pattern.row.end()),
        a_(pattern.row.size()) {
    klu_defaults(&common_);
    if (order == Order::columns) {
      common_.btf = 0;
      common_.ordering = 1;
    }
    symbolic_ = klu_analyze(size_, column_start_.data(), row_.data(), &common_);
    if (symbolic_ == nullptr)
      throw std::invalid_argument("the Jacobian pattern is structurally singular");
  }
  ~SparseMatrix() override {
    forget();
    klu_free_symbolic(&symbolic_, &common_);
  }
  SparseMatrix(const SparseMatrix&) = delete;
  SparseMatrix& operator=(const SparseMatrix&) = delete;

  Scalar* values() override { return a_.data(); }

  bool factor() override {
    for (const Scalar& x : a_)
      if (!std::isfinite(std::abs(x))) return false;
    if (numeric_ != nullptr && again()) return true;
    forget();
    ++choices_;
    int* start = column_start_.data();
    if constexpr (is_real)
      numeric_ = klu_factor(start, row_.data(), numbers(), symbolic_, &common_);
    else
      numeric_ = klu_z_factor(start, row_.data(), numbers(), symbolic_, &common_);
    if (numeric_ == nullptr || common_.status != KLU_OK) return false;
    fresh_growth_ = growth();
    return true;
  }
  long choices() const override { return choices_; }

  void solve(Scalar* b) override {
    if constexpr (is_real)
      klu_solve(symbolic_, numeric_, size_, 1, b, &common_);
    else
      klu_z_solve(symbolic_, numeric_, size_, 1, reinterpret_cast<double*>(b), &common_);
  }

 private:
  /// Entries as doubles; complex ones are pairs of real and imaginary part, by the standard.
  double* numbers() { return reinterpret_cast<double*>(a_.data()); }

  /// Factorises new values on the old pivots.
  bool again() {
    int* start = column_start_.data();
    if constexpr (is_real)
      klu_refactor(start, row_.data(), numbers(), symbolic_, numeric_, &common_);
    else
      klu_z_refactor(start, row_.data(), numbers(), symbolic_, numeric_, &common_);
    return common_.status == KLU_OK &&
           growth() < std::max(most_growth, beside_fresh * fresh_growth_);
  }
  /// Largest growth of entries from A to U over the columns. Infinite where it is not known.
  double growth() {
    int* start = column_start_.data();
    int known = 0;
    if constexpr (is_real)
      known = klu_rgrowth(start, row_.data(), numbers(), symbolic_, numeric_, &common_);
    else
      known = klu_z_rgrowth(start, row_.data(), numbers(), symbolic_, numeric_, &common_);
    return known != 0 && common_.rgrowth > 0 ? 1 / common_.rgrowth : HUGE_VAL;
  }
  void forget() {
    if (numeric_ == nullptr) return;
    if constexpr (is_real)
      klu_free_numeric(&numeric_, &common_);
    else
      klu_z_free_numeric(&numeric_, &common_);
  }

  int size_;
  std::vector<int> column_start_, row_;
  std::vector<Scalar> a_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  double fresh_growth_ = 0;
  long choices_ = 0;
};

}  // namespace

template <class Scalar>
std::unique_ptr<NewtonMatrix<Scalar>> make_newton_matrix(int size, const JacobianPattern& pattern) {
  if (pattern.column_start.empty()) return std::make_unique<DenseMatrix<Scalar>>(size);
  if (pattern.column_start.size() != static_cast<std::size_t>(size) + 1 ||
      static_cast<std::size_t>(pattern.column_start.back()) != pattern.row.size())
    throw std::invalid_argument("the Jacobian pattern does not fit the system");
  return std::make_unique<SparseMatrix<Scalar>>(size, pattern);
}

/// Local matrices have zeros all over the diagonal: AMD's order is for pivots on it, and those KLU
/// then takes fill.
template <class Scalar>
std::unique_ptr<NewtonMatrix<Scalar>> make_local_matrix(const JacobianPattern& pattern) {
  using Matrix = SparseMatrix<Scalar>;
  const auto size = static_cast<int>(pattern.column_start.size()) - 1;
  return std::make_unique<Matrix>(size, pattern, Matrix::Order::columns);
}

template std::unique_ptr<NewtonMatrix<double>> make_newton_matrix(int, const JacobianPattern&);
template std::unique_ptr<NewtonMatrix<std::complex<double>>> make_newton_matrix(
    int, const JacobianPattern&);
template std::unique_ptr<NewtonMatrix<double>> make_local_matrix(const JacobianPattern&);
template std::unique_ptr<NewtonMatrix<std::complex<double>>> make_local_matrix(
    const JacobianPattern&);

}  // namespace momenta
