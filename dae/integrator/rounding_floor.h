#pragma once
// Newton's method of IDA with a floor of rounding for its corrections.
//
// A correction is J⁻¹ F, and F comes with roundings: of y and y' as they are stored and of its own
// operations. J⁻¹ may carry them far: with Φ(q) = 0 among the rows, an opening of ε |q| is answered
// by an impulse of ε |q| over the step, and that by a change of p that no shorter step lessens. IDA
// asks of corrections that each is smaller than the one before; at the floor none is, and a step
// that is solved as well as it can be is taken for one that does not converge.
//
// So where IDA's test gives up, the floor is measured: every number of y and y' moved by one
// rounding, up or down by chance, what F changes by, through the factors at hand,
//
//   δ = J⁻¹ [F(t, y + ρ, y' + ρ') − F(t, y, y')],
//
// root mean square of three samples in IDA's norm. The iteration is at its end when its correction
// is no more than a few δ, and if that is still well within the tolerance the step is as good as
// any.
//
// Source: Higham, Accuracy and Stability of Numerical Algorithms, ch. 25, for the limiting accuracy
// of Newton's method.

#include <momenta/dae/integrator/sundials_handles.h>

#include <functional>
#include <random>

namespace momenta {

class RoundingFloor {
 public:
  /// r = F(t, y, y'); false: no value.
  using Residual = std::function<bool(double t, const double* y, const double* ydot, double* r)>;

  RoundingFloor(int size, const sundials::Context& context, Residual residual);
  RoundingFloor(const RoundingFloor&) = delete;
  RoundingFloor& operator=(const RoundingFloor&) = delete;

  /// To be called before the first step; the solver and its matrix are IDA's.
  void attach(void* ida, SUNLinearSolver solver, SUNMatrix matrix);

  /// The floor in tolerances, where the last trial of a step did not converge because of it; else
  /// 0.
  double reached() const { return reached_; }
  void forget() { reached_ = 0; }
  /// ‖δ‖ at IDA's last y and y', with its weights and last factors; not finite where F has no
  /// value. Four evaluations of F.
  double here();
  long evaluations() const { return evaluations_; }

 private:
  static int test(SUNNonlinearSolver newton, N_Vector sum, N_Vector correction, double bound,
                  N_Vector weight, void* self);
  double measure(N_Vector weight);

  Residual residual_;
  void* ida_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNNonlinSolConvTestFn own_test_ = nullptr;  ///< IDA's
  void* own_data_ = nullptr;
  sundials::NonlinearSolver newton_;
  sundials::Vector y_, ydot_, r_, moved_, delta_, weight_;
  std::minstd_rand chance_;
  double reached_ = 0;
  long evaluations_ = 0;
};

}  // namespace momenta
