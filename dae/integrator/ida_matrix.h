#pragma once
// Newton's matrix ∂F/∂y + c ∂F/∂y' as IDA takes it, and the solver of its linear systems: dense LU,
// KLU on the system's pattern, or KLU on a larger local matrix (local_newton.h).

#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/integrator/sundials_handles.h>

namespace momenta {

class IdaMatrix {
 public:
  enum class Filled { yes, not_evaluated, not_finite };

  /// @pre the system has started: which of the three is known then. `like`: a vector of its size.
  /// @throws std::invalid_argument when the system's pattern does not fit its size
  IdaMatrix(DaeSystem& system, const sundials::Context& context, N_Vector like);

  const char* linear_solver() const { return local_ ? "KLU, local" : sparse_ ? "KLU" : "dense LU"; }
  SUNMatrix matrix() { return local_ ? local_->matrix() : matrix_.get(); }
  SUNLinearSolver solver() { return local_ ? local_->solver() : solver_.get(); }
  /// Fills `matrix` at y and y' of the system's size. @pre `matrix` is matrix() or IDA's copy of it
  Filled fill(double t, const double* y, const double* ydot, double c, SUNMatrix matrix);

 private:
  DaeSystem& system_;
  bool sparse_ = false;
  sundials::Matrix matrix_;
  sundials::LinearSolver solver_;
  std::unique_ptr<LocalNewton> local_;  ///< null: one of the other two
};

}  // namespace momenta
