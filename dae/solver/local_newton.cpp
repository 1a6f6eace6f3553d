#include <momenta/dae/solver/local_newton.h>

#include <algorithm>

namespace momenta {

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
