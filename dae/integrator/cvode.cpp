// y' = f(t, y) by CVODE: Adams-Moulton methods (orders 1-12, fixed-point iteration) for smooth
// nonstiff motion, BDF (orders 1-5, Newton with a dense difference-quotient Jacobian) for stiff
// ones.
//
// A multistep method carries the past of y in its history, so a state cannot be altered after a
// step: with adams `after_step` of the system is not called, gauge and drift have to be in f. With
// bdf its change of y goes through CVODE's projection function, which corrects the history too and
// comes before the error test (of the unprojected error): positions, velocities and quaternions may
// be corrected so, a gauge not. CVODE is for comparison and for stiff ODE forms;
// explicit_runge_kutta.cpp is cheaper wherever both work.
// Source: Hindmarsh et al., SUNDIALS, ACM TOMS 31 (2005) 363-396; Byrne, Hindmarsh, ACM TOMS 1
// (1975) 71-96; projection: Eich, SIAM J. Numer. Anal. 30 (1993) 1467-1482.

#include <cvode/cvode_proj.h>
#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/multistep_run.h>
#include <momenta/dae/integrator/sundials_handles.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

// CVODE's defaults are 7 and 10. A run that passes a sharp peak cuts a step further.
/// The first step over the horizon, where the end is beyond that: its own guess is tied to the end.
constexpr double far_first_step = 1e-10;
constexpr int max_error_test_failures = 15;
constexpr int max_convergence_failures = 15;
constexpr int highest_order_adams = 12, highest_order_bdf = 5;

using sundials::check;

class Cvode {
 public:
  Cvode(bool stiff, OdeSystem& system, double t0, const std::vector<double>& y0, double end,
        const IntegrationOptions& options)
      : system_(system),
        stiff_(stiff),
        y_(system.size(), context_),
        output_(system.size(), context_),
        tolerance_(system.size(), context_),
        memory_(sundials::require(CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context_)), {CVodeFree}) {
    std::copy(y0.begin(), y0.end(), y_.data());
    for (int i = 0; i < system.size(); ++i) {
      const double scale = system.scale(i);
      tolerance_[i] = std::isinf(scale) ? scale : options.atol * scale;
    }
    void* cvode = memory_.get();
    check(CVodeSetErrHandlerFn(cvode, sundials::silent, nullptr), "CVodeSetErrHandlerFn");
    check(CVodeInit(cvode, rhs, t0, y_), "CVodeInit");
    check(CVodeSetUserData(cvode, this), "CVodeSetUserData");
    check(CVodeSVtolerances(cvode, options.rtol, tolerance_), "CVodeSVtolerances");
    if (stiff) {
      matrix_.reset(sundials::require(SUNDenseMatrix(y_.size(), y_.size(), context_)));
      linear_solver_.reset(sundials::require(SUNLinSol_Dense(y_, matrix_.get(), context_)));
      check(CVodeSetLinearSolver(cvode, linear_solver_.get(), matrix_.get()),
            "CVodeSetLinearSolver");
      if (system.has_after_step()) {
        check(CVodeSetProjFn(cvode, project), "CVodeSetProjFn");
        check(CVodeSetProjErrEst(cvode, SUNFALSE), "CVodeSetProjErrEst");
      }
    } else {
      fixed_point_.reset(sundials::require(SUNNonlinSol_FixedPoint(y_, 0, context_)));
      check(CVodeSetNonlinearSolver(cvode, fixed_point_.get()), "CVodeSetNonlinearSolver");
    }
    check(CVodeSetMaxErrTestFails(cvode, max_error_test_failures), "CVodeSetMaxErrTestFails");
    check(CVodeSetMaxConvFails(cvode, max_convergence_failures), "CVodeSetMaxConvFails");
    check(CVodeSetMaxNumSteps(cvode, -1), "CVodeSetMaxNumSteps");
    if (options.max_order > 0)
      check(CVodeSetMaxOrd(cvode, std::min(options.max_order,
                                           stiff ? highest_order_bdf : highest_order_adams)),
            "CVodeSetMaxOrd");
    if (options.max_step > 0) check(CVodeSetMaxStep(cvode, options.max_step), "CVodeSetMaxStep");
    if (options.initial_step > 0)
      check(CVodeSetInitStep(cvode, std::min(options.initial_step, end - t0)), "CVodeSetInitStep");
    else if (end - t0 > system.horizon())
      check(CVodeSetInitStep(cvode, far_first_step * system.horizon()), "CVodeSetInitStep");
  }

  const char* name() const { return stiff_ ? "bdf" : "adams"; }
  double* y() { return y_.data(); }
  double* ydot() { return nullptr; }

  bool step(double& t, double end, std::string& cause) {
    const double t0 = t;
    if (end != stop_) check(CVodeSetStopTime(memory_.get(), stop_ = end), "CVodeSetStopTime");
    evaluation_failed_ = not_finite_ = false;
    system_.begin_step(t, y_.data());
    const int flag = CVode(memory_.get(), end, y_, &t, CV_ONE_STEP);
    if (flag == CV_SUCCESS || flag == CV_TSTOP_RETURN) {
      if (!all_finite(y_.data(), y_.size())) {
        cause = "a value that is not a finite number came up";
        return false;
      }
      // A step shortened over and over before a point it cannot pass would go on without length.
      if (t < end && t - t0 < 4 * std::numeric_limits<double>::epsilon() * std::abs(t)) {
        cause = "the step became as short as the rounding of t" + inner_cause();
        return false;
      }
      return true;
    }
    cause = explain(flag);
    return false;
  }

  bool at(double t, double* y, double*) {
    if (CVodeGetDky(memory_.get(), t, 0, output_) != CV_SUCCESS)
      return std::fill_n(y, y_.size(), std::numeric_limits<double>::quiet_NaN()), false;
    std::copy_n(output_.data(), y_.size(), y);
    return true;
  }

  Counters counters() {
    Counters c;
    void* cvode = memory_.get();
    long setups = 0, error_failures = 0, solve_failures = 0;
    int order = 0, next_order = 0;
    double first = 0, last = 0, next = 0, now = 0;
    check(CVodeGetIntegratorStats(cvode, &c.steps, &c.evaluations, &setups, &error_failures, &order,
                                  &next_order, &first, &last, &next, &now),
          "CVodeGetIntegratorStats");
    check(CVodeGetNumNonlinSolvIters(cvode, &c.newton_iterations), "CVodeGetNumNonlinSolvIters");
    check(CVodeGetNumStepSolveFails(cvode, &solve_failures), "CVodeGetNumStepSolveFails");
    c.rejected = error_failures + solve_failures;
    if (!stiff_) return c;
    long in_quotients = 0;
    check(CVodeGetNumLinRhsEvals(cvode, &in_quotients), "CVodeGetNumLinRhsEvals");
    check(CVodeGetNumJacEvals(cvode, &c.jacobians), "CVodeGetNumJacEvals");
    c.evaluations += in_quotients;
    c.factorizations = setups;
    return c;
  }

 private:
  /// 1 tells CVODE to try a shorter step.
  static int rhs(double t, N_Vector y, N_Vector ydot, void* self) {
    Cvode& cvode = *static_cast<Cvode*>(self);
    double* values = N_VGetArrayPointer(ydot);
    const bool evaluated = cvode.system_.rhs(t, N_VGetArrayPointer(y), values);
    if (!evaluated) return cvode.evaluation_failed_ = true, 1;
    if (all_finite(values, cvode.y_.size())) return 0;
    cvode.not_finite_ = true;
    return 1;
  }

  /// Changes y as the system does after a step.
  static int project(double t, N_Vector y, N_Vector change, double, N_Vector, void* self) {
    Cvode& cvode = *static_cast<Cvode*>(self);
    double* values = N_VGetArrayPointer(change);
    std::copy_n(N_VGetArrayPointer(y), cvode.y_.size(), values);
    bool changed = false;
    if (!cvode.system_.after_step(t, values, changed)) return cvode.evaluation_failed_ = true, 1;
    N_VLinearSum(1, change, -1, y, change);
    if (all_finite(values, cvode.y_.size())) return 0;
    cvode.not_finite_ = true;
    return 1;
  }

  /// Why a trial of the present step failed, if one did.
  std::string inner_cause() const {
    if (evaluation_failed_) return ": " + evaluation_cause(system_.failure());
    return not_finite_ ? ": a value that is not a finite number came up" : "";
  }

  std::string explain(int flag) const {
    const std::string inner = inner_cause();
    switch (flag) {
      case CV_TOO_MUCH_ACC:
        return "the tolerance asks for more than double precision has";
      case CV_ERR_FAILURE:
        return "the local error stayed above its tolerance with the shortest step" + inner;
      case CV_CONV_FAILURE:
        return "the corrector did not converge with the shortest step" + inner;
      case CV_PROJFUNC_FAIL:
      case CV_REPTD_PROJFUNC_ERR:
        return "the correction of the state failed with the shortest step" + inner;
      case CV_LSETUP_FAIL:
      case CV_LSOLVE_FAIL:
        return "the Newton matrix could not be made or factorised" + inner;
      case CV_RHSFUNC_FAIL:
      case CV_FIRST_RHSFUNC_ERR:
      case CV_REPTD_RHSFUNC_ERR:
      case CV_UNREC_RHSFUNC_ERR:
        return "the right-hand side failed with the shortest step" + inner;
      default: {
        char* text = CVodeGetReturnFlagName(flag);
        const std::string named = text != nullptr ? text : std::to_string(flag);
        std::free(text);
        return "the integrator gave up with " + named + inner;
      }
    }
  }

  OdeSystem& system_;
  bool stiff_;
  sundials::Context context_;  // before everything made with it
  sundials::Vector y_, output_, tolerance_;
  sundials::Matrix matrix_;
  sundials::LinearSolver linear_solver_;
  sundials::NonlinearSolver fixed_point_;
  sundials::Integrator memory_;
  double stop_ = std::numeric_limits<double>::quiet_NaN();  ///< stop that CVODE knows of [s]
  bool evaluation_failed_ = false, not_finite_ = false;     ///< in a trial of the present step
};

}  // namespace

IntegrationResult integrate_cvode(const std::string& method, OdeSystem& system, double t0,
                                  const std::vector<double>& y0,
                                  const std::vector<double>& output_times,
                                  const IntegrationOptions& options, const Observer& observer) {
  if (method != "adams" && method != "bdf")
    throw std::invalid_argument("no method \"" + method + "\" of CVODE: adams, bdf are known");
  if (y0.size() != static_cast<std::size_t>(system.size()))
    throw std::invalid_argument("the start state must have the size of the system");
  expect_tolerances(options, method);
  const OutputCursor outputs(t0, output_times);
  const bool stiff = method == "bdf";
  Cvode cvode(stiff, system, t0, y0, outputs.end(), options);
  IntegrationResult result;
  if (stiff) {
    result.linear_solver = "dense LU";
    result.jacobian = "difference quotient";
  }
  MultistepRun<Cvode>(cvode, system.size(), t0, output_times, options, observer).run(result);
  result.counters = cvode.counters();
  return result;
}

namespace {

template <bool stiff>
IntegrationResult integrate(OdeSystem& system, double t0, const std::vector<double>& y0,
                            const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  return integrate_cvode(stiff ? "bdf" : "adams", system, t0, y0, output_times, options, observer);
}

}  // namespace

Integrator adams_integrator() {
  return {.name = "adams",
          .step = Integrator::Step::adaptive,
          .multistep = true,
          .method = "CVODE, Adams-Moulton of orders 1 to 12",
          .ode_run = integrate<false>};
}

Integrator bdf_integrator() {
  return {.name = "bdf",
          .step = Integrator::Step::adaptive,
          .multistep = true,
          .projects = true,
          .method = "CVODE, BDF of orders 1 to 5",
          .ode_run = integrate<true>};
}

}  // namespace momenta
