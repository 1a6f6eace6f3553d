#include <momenta/dae/kkt/klu_solver.h>

#include <algorithm>

namespace momenta {
namespace {

constexpr int most_refinements = 3;    // one does, two where a pivot is as small as ε
constexpr double at_rounding = 1e-11;  // of the residual, row by row
constexpr double most_growth = 1e3;    // of the entries, beside that on pivots just chosen

}  // namespace

KluSolver::KluSolver(int size, int soft, const std::vector<KktPattern::Entry>& entries, Order order)
    : matrix_(size, entries),
      hard_(static_cast<std::size_t>(size - soft)),
      epsilon_(static_cast<std::size_t>(soft)),
      given_(static_cast<std::size_t>(size)),
      b_(given_.size()),
      x_(given_.size()),
      r_(given_.size()) {
  klu_defaults(&common_);
  if (order == Order::columns) {
    common_.btf = 0;
    common_.ordering = 1;
  }
  symbolic_ = klu_analyze(size, matrix_.start.data(), matrix_.row.data(), &common_);
}

KluSolver::~KluSolver() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
}

bool KluSolver::factor(const std::vector<double>& epsilon) {
  epsilon_ = epsilon;
  for (std::size_t i = 0; i < epsilon_.size(); ++i)
    matrix_.set_diagonal(static_cast<int>(hard_ + i), -epsilon_[i]);
  singular_ = -1;
  if (!matrix_.finite()) return false;
  auto* values = const_cast<double*>(matrix_.values().data());  // KLU's interface; it reads them
  if (numeric_ &&
      klu_refactor(matrix_.start.data(), matrix_.row.data(), values, symbolic_, numeric_,
                   &common_) == 1 &&
      common_.status == KLU_OK &&
      klu_rgrowth(matrix_.start.data(), matrix_.row.data(), values, symbolic_, numeric_,
                  &common_) == 1 &&
      most_growth * common_.rgrowth > fresh_)
    return true;
  return factor_anew();
}

bool KluSolver::factor_anew() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  ++choices_;
  auto* values = const_cast<double*>(matrix_.values().data());
  numeric_ = symbolic_
                 ? klu_factor(matrix_.start.data(), matrix_.row.data(), values, symbolic_, &common_)
                 : nullptr;
  if (numeric_ && common_.status == KLU_OK) {
    klu_rgrowth(matrix_.start.data(), matrix_.row.data(), values, symbolic_, numeric_, &common_);
    fresh_ = common_.rgrowth;
    return true;
  }
  singular_ = symbolic_ && common_.status == KLU_SINGULAR ? common_.singular_col : -1;
  return false;
}

bool KluSolver::solve(double* x, const double* centre, bool is_model) {
  std::copy(x, x + given_.size(), given_.begin());
  if (!attempt(centre, is_model) && !(factor_anew() && attempt(centre, is_model))) return false;
  std::copy(x_.begin(), x_.end(), x);
  return true;
}

/// Refined against the same equations centred on the σ just found: that removes rounding and takes
/// the bias of ε from ε/W to (ε/W)².
bool KluSolver::attempt(const double* centre, bool is_model) {
  const int size = matrix_.size();
  b_ = given_;
  for (std::size_t i = 0; i < epsilon_.size() && centre; ++i)
    b_[hard_ + i] -= epsilon_[i] * centre[i];
  x_ = b_;
  if (klu_solve(symbolic_, numeric_, size, 1, x_.data(), &common_) != 1) return false;
  for (std::size_t i = 0; i < epsilon_.size() && !is_model; ++i)
    b_[hard_ + i] -= epsilon_[i] * (x_[hard_ + i] - (centre ? centre[i] : 0.0));
  matrix_.residual(b_.data(), x_.data(), r_.data());
  for (int step = 0; step < most_refinements; ++step) {
    if (klu_solve(symbolic_, numeric_, size, 1, r_.data(), &common_) != 1) return false;
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += r_[i];
    if (matrix_.residual(b_.data(), x_.data(), r_.data()) < at_rounding) return true;
  }
  return false;
}

}  // namespace momenta
