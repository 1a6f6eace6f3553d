// Rows of F come in any units, momenta of light bodies beside those of heavy ones and lengths:
// dense rows are divided by their largest entries before pivots are sought among them, as KLU does
// by itself.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/local_newton.h>

#include <algorithm>
#include <cmath>

namespace momenta {

DaeNewton::DaeNewton(DaeSystem& system)
    : system_(system), local_(system.local()), n_(static_cast<std::size_t>(system.size())) {
  if (local_ != nullptr) return;
  matrix_ = make_newton_matrix<double>(system.size(), system.pattern());
  if (system.pattern().column_start.empty()) row_scale_.resize(n_);
}

const char* DaeNewton::linear_solver() const {
  return local_ != nullptr ? "KLU, local" : linear_solver_name(system_.pattern());
}

DaeNewton::Made DaeNewton::make(double t, const double* y, const double* ydot, double c) {
  if (local_ != nullptr) {
    if (!local_->evaluate(t, y, ydot, c)) return Made::not_evaluated;
    if (!matrix_ || version_ != local_->version()) {
      matrix_.reset();
      version_ = local_->version();
      matrix_ = make_local_matrix(local_->pattern());
      work_.assign(local_->pattern().column_start.size() - 1, 0.0);
    }
    std::copy(local_->values().begin(), local_->values().end(), matrix_->values());
  } else {
    double* values = matrix_->values();
    if (!system_.jacobian(t, y, ydot, c, values)) return Made::not_evaluated;
    if (!all_finite(values, entry_count(static_cast<int>(n_), system_.pattern())))
      return Made::not_finite;
    if (!row_scale_.empty()) scale_rows();
  }
  return matrix_->factor() ? Made::yes : Made::singular;
}

void DaeNewton::scale_rows() {
  double* values = matrix_->values();
  std::fill(row_scale_.begin(), row_scale_.end(), 0.0);
  for (std::size_t j = 0; j < n_; ++j)
    for (std::size_t i = 0; i < n_; ++i)
      row_scale_[i] = std::max(row_scale_[i], std::abs(values[j * n_ + i]));
  for (double& scale : row_scale_) scale = scale > 0 ? 1 / scale : 1;
  for (std::size_t j = 0; j < n_; ++j)
    for (std::size_t i = 0; i < n_; ++i) values[j * n_ + i] *= row_scale_[i];
}

void DaeNewton::solve(double* b) {
  for (std::size_t i = 0; i < row_scale_.size(); ++i) b[i] *= row_scale_[i];
  if (local_ == nullptr) return matrix_->solve(b);
  std::copy_n(b, n_, work_.begin());
  std::fill(work_.begin() + static_cast<std::ptrdiff_t>(n_), work_.end(), 0.0);
  matrix_->solve(work_.data());
  std::copy_n(work_.begin(), n_, b);
}

LocalNewton::LocalNewton(LocalJacobian& jacobian, int size, const sundials::Context& context)
    : jacobian_(jacobian),
      size_(static_cast<std::size_t>(size)),
      matrix_(sundials::require(SUNMatNewEmpty(context))),
      solver_(sundials::require(SUNLinSolNewEmpty(context))) {
  matrix_->ops->getid = [](SUNMatrix) { return SUNMATRIX_CUSTOM; };
  matrix_->ops->zero = [](SUNMatrix) { return SUNMAT_SUCCESS; };  // all entries are written anyway
  solver_->content = this;
  solver_->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
  solver_->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
  solver_->ops->initialize = [](SUNLinearSolver) -> int { return SUNLS_SUCCESS; };
  solver_->ops->setup = [](SUNLinearSolver s, SUNMatrix) -> int {
    return static_cast<LocalNewton*>(s->content)->factor() ? SUNLS_SUCCESS : SUNLS_LUFACT_FAIL;
  };
  solver_->ops->solve = [](SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, double) -> int {
    static_cast<LocalNewton*>(s->content)->solve(N_VGetArrayPointer(x), N_VGetArrayPointer(b));
    return SUNLS_SUCCESS;
  };
  solver_->ops->free = [](SUNLinearSolver s) -> int {
    s->content = nullptr;  // not SUNDIALS' own
    SUNLinSolFreeEmpty(s);
    return SUNLS_SUCCESS;
  };
}

bool LocalNewton::evaluate(double t, const double* y, const double* ydot, double c) {
  if (!jacobian_.evaluate(t, y, ydot, c)) return false;
  if (version_ != jacobian_.version()) {
    newton_.reset();
    version_ = jacobian_.version();
    newton_ = make_local_matrix(jacobian_.pattern());
    work_.assign(jacobian_.pattern().column_start.size() - 1, 0.0);
  }
  std::copy(jacobian_.values().begin(), jacobian_.values().end(), newton_->values());
  return true;
}

bool LocalNewton::factor() {
  return newton_ && newton_->factor();
}

void LocalNewton::solve(double* x, const double* b) {
  const auto end = work_.begin() + static_cast<std::ptrdiff_t>(size_);
  std::copy(b, b + size_, work_.begin());
  std::fill(end, work_.end(), 0.0);
  newton_->solve(work_.data());
  std::copy(work_.begin(), end, x);
}

}  // namespace momenta
