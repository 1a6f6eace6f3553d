#include <momenta/dae/integrator/rounding_floor.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <cmath>
#include <limits>

namespace momenta {
namespace {

/// Samples of δ, and the scatter of corrections at the floor about their root mean square.
constexpr int samples = 3;
constexpr double scatter = 4;
/// Largest correction, in tolerances, that passes. IDA's default would leave 0.33, but differences
/// of order five, which choose order and step, have sixteen times the noise of a step.
constexpr double most = 0.1;
/// IDA's number.
constexpr int most_corrections = 4;

}  // namespace

RoundingFloor::RoundingFloor(int size, const sundials::Context& context, Residual residual)
    : residual_(std::move(residual)),
      y_(size, context),
      ydot_(size, context),
      r_(size, context),
      moved_(size, context),
      delta_(size, context),
      weight_(size, context) {
  newton_.reset(sundials::require(SUNNonlinSol_Newton(y_, context)));
}

void RoundingFloor::attach(void* ida, SUNLinearSolver solver, SUNMatrix matrix) {
  ida_ = ida;
  solver_ = solver;
  matrix_ = matrix;
  sundials::check(IDASetNonlinearSolver(ida, newton_.get()), "IDASetNonlinearSolver");
  sundials::check(IDASetMaxNonlinIters(ida, most_corrections), "IDASetMaxNonlinIters");
  const auto& content = *static_cast<SUNNonlinearSolverContent_Newton>(newton_->content);
  own_test_ = content.CTest;
  own_data_ = content.ctest_data;
  sundials::check(SUNNonlinSolSetConvTestFn(newton_.get(), test, this),
                  "SUNNonlinSolSetConvTestFn");
}

int RoundingFloor::test(SUNNonlinearSolver newton, N_Vector sum, N_Vector correction, double bound,
                        N_Vector weight, void* self) {
  RoundingFloor& floor = *static_cast<RoundingFloor*>(self);
  const int found = floor.own_test_(newton, sum, correction, bound, weight, floor.own_data_);
  int iteration = 0;
  SUNNonlinSolGetCurIter(newton, &iteration);
  const bool is_last = found == SUN_NLS_CONTINUE && iteration + 1 >= most_corrections;
  if (found != SUN_NLS_CONV_RECVR && !is_last) return found;
  const double size = N_VWrmsNorm(correction, weight), rounding = floor.measure(weight);
  const bool at_floor = size <= scatter * rounding;
  if (at_floor && size <= most) return SUN_NLS_SUCCESS;
  floor.reached_ = at_floor ? rounding : 0;
  return found;
}

double RoundingFloor::here() {
  sundials::check(IDAGetErrWeights(ida_, weight_), "IDAGetErrWeights");
  return measure(weight_);
}

double RoundingFloor::measure(N_Vector weight) {
  constexpr double one = std::numeric_limits<double>::epsilon();
  double t = 0;
  N_Vector y = nullptr, ydot = nullptr;
  if (IDAGetCurrentTime(ida_, &t) != IDA_SUCCESS || IDAGetCurrentY(ida_, &y) != IDA_SUCCESS ||
      IDAGetCurrentYp(ida_, &ydot) != IDA_SUCCESS)
    return std::numeric_limits<double>::quiet_NaN();
  const auto moved = [&](N_Vector from, sundials::Vector& to) {
    const double* x = N_VGetArrayPointer(from);
    for (int i = 0; i < to.size(); ++i) to[i] = x[i] * ((chance_() & 64u) != 0 ? 1 + one : 1 - one);
  };
  constexpr auto nothing = std::numeric_limits<double>::quiet_NaN();
  ++evaluations_;
  if (!residual_(t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot), r_.data())) return nothing;
  double sum = 0;
  for (int sample = 0; sample < samples; ++sample) {
    moved(y, y_);
    moved(ydot, ydot_);
    ++evaluations_;
    if (!residual_(t, y_.data(), ydot_.data(), moved_.data())) return nothing;
    N_VLinearSum(1, moved_, -1, r_, moved_);
    if (SUNLinSolSolve(solver_, matrix_, delta_, moved_, 0) != SUNLS_SUCCESS) return nothing;
    const double norm = N_VWrmsNorm(delta_, weight);
    sum += norm * norm;
  }
  return std::sqrt(sum / samples);
}

}  // namespace momenta
