#include <momenta/dae/kkt/klu_solver.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr int most_refinements = 3;    // one suffices, two where a pivot is as small as ε
constexpr double at_rounding = 1e-11;  // relative residual of a row
constexpr double most_growth = 1e3;    // growth of entries, relative to that on fresh pivots

}  // namespace

KluSolver::KluSolver(int size, int soft, const std::vector<KktPattern::Entry>& entries, Order order)
    : matrix_(size, entries),
      hard_(static_cast<std::size_t>(size - soft)),
      epsilon_(static_cast<std::size_t>(soft)),
      centre_(epsilon_.size()),
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

double KluSolver::pivot_ratio() {
  return numeric_ && klu_rcond(symbolic_, numeric_, &common_) == 1 ? common_.rcond : 0;
}

bool KluSolver::solve(double* x, const double* centre, bool is_model) {
  std::copy(x, x + given_.size(), given_.begin());
  if (!attempt(centre, is_model) && !(factor_anew() && attempt(centre, is_model))) return false;
  std::copy(x_.begin(), x_.end(), x);
  return true;
}

/// Solves, then recentres on the σ just found as long as that reduces the error of the rows of Φ to
/// a tenth: the bias ε/W becomes (ε/W)², (ε/W)³ … on regular rows, however weak in a long
/// mechanism; that of a row lost in rounding stays. Every solution is refined.
bool KluSolver::attempt(const double* centre, bool is_model) {
  constexpr int most_recentrings = 5;
  constexpr double negligible = 1e-14, regular = 0.1;
  const int size = matrix_.size();
  b_ = given_;
  for (std::size_t i = 0; i < epsilon_.size(); ++i) {
    centre_[i] = centre ? centre[i] : 0.0;
    b_[hard_ + i] -= epsilon_[i] * centre_[i];
  }
  x_ = b_;
  if (klu_solve(symbolic_, numeric_, size, 1, x_.data(), &common_) != 1) return false;
  matrix_.residual(b_.data(), x_.data(), r_.data());
  double last = HUGE_VAL;
  for (int pass = 0; pass <= most_recentrings; ++pass) {
    if (!is_model) {
      double off = 0;
      for (std::size_t i = 0; i < epsilon_.size(); ++i) {
        const double own = std::abs(epsilon_[i] * (x_[hard_ + i] - centre_[i]));
        if (own > 0) off = std::max(off, own / matrix_.row_size(hard_ + i));
      }
      if (pass > 0 && (off < negligible || off > regular * last)) return true;
      last = off;
      for (std::size_t i = 0; i < epsilon_.size(); ++i) {
        const double change = epsilon_[i] * (x_[hard_ + i] - centre_[i]);
        centre_[i] = x_[hard_ + i];
        b_[hard_ + i] -= change;
        r_[hard_ + i] -= change;
      }
    }
    bool refined = false;
    for (int step = 0; step < most_refinements && !refined; ++step) {
      if (klu_solve(symbolic_, numeric_, size, 1, r_.data(), &common_) != 1) return false;
      for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += r_[i];
      refined = matrix_.residual(b_.data(), x_.data(), r_.data()) < at_rounding;
    }
    if (!refined) return false;
    if (is_model) return true;
  }
  return true;
}

}  // namespace momenta
