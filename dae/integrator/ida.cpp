// F(t, y, y') = 0 by IDA: variable-order, variable-step BDF in fixed leading coefficient form,
// Newton's method with the system's exact matrix ∂F/∂y + c ∂F/∂y', factorised densely or by KLU.
//
// What matters with constrained mechanisms, whose index is above 1 in most forms:
// - multipliers (and whatever else `differential` denies) take no part in the local error test
//   (IDASetSuppressAlg): their error is of a lower order, and the test would shrink the step for
//   ever;
// - where scale is infinite they take no part in the Newton norm either: at the first, tiny steps
//   their noise is of the order of ε/h, and no tolerance fits;
// - of systems that say so, errors are filtered before they are tested (filtered_error.h);
// - y and y' at the start satisfy all constraints, also hidden ones: IDA's own correction of
//   initial values treats index 1 only.
// Source: Hindmarsh et al., SUNDIALS, ACM TOMS 31 (2005) 363-396; Brenan, Campbell, Petzold,
// Numerical Solution of Initial-Value Problems in Differential-Algebraic Equations, ch. 5.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/filtered_error.h>
#include <momenta/dae/integrator/ida_matrix.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/ode_restart.h>
#include <momenta/dae/integrator/rounding_floor.h>
#include <momenta/dae/integrator/sundials_handles.h>
#include <momenta/dae/integrator/system.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>

namespace momenta {
namespace {

/// Fraction of the tolerance at which Newton stops; IDA's default is 0.33. What Newton leaves is
/// noise of the error estimate: with 0.03 index-2 forms of Andrews' mechanism need up to 40 % fewer
/// steps at the same error; less saves no more.
constexpr double newton_fraction = 0.03;

/// First step over the span. IDA's own guess follows y' over the tolerance and gets so small that
/// ε/h spoils the multipliers; too long a first step costs a few rejections only.
constexpr double first_step_fraction = 1e-4;
constexpr double first_step_retry = 0.01;
constexpr int first_step_retries = 2;

// IDA's defaults are 10 and 10. A step at which a mechanism passes an impact-like peak is cut
// further.
constexpr int max_error_test_failures = 15;
constexpr int max_convergence_failures = 15;
constexpr int highest_order = 5;

/// Steps of order 1 in a row accepted only after a rejection, and steps of one length after them.
/// Where Φ = 0 gives σ, the formula of order 1 errs in u by h/2 times the turn of Φ_q, σ answers,
/// and a step twice as long, by another σ, is off in p; while no two steps are equally long IDA
/// does not raise the order.
constexpr int most_stuck = 10, held_steps = 8;

using sundials::check;

class Ida {
 public:
  Ida(DaeSystem& system, const IntegrationOptions& options, double span)
      : system_(system),
        options_(options),
        span_(span),
        y_(system.size(), context_),
        ydot_(system.size(), context_),
        output_(system.size(), context_),
        tolerance_(system.size(), context_),
        differential_(system.size(), context_),
        floor_(system.size(), context_,
               [&system](double t, const double* y, const double* ydot, double* r) {
                 return system.residual(t, y, ydot, r);
               }),
        memory_(sundials::require(IDACreate(context_)), {IDAFree}) {
    for (int i = 0; i < system.size(); ++i) {
      // 1/(rtol |y_i| + ∞) = 0: IDA accepts a weight of zero, as long as no tolerance is zero.
      const double scale = system.scale(i);
      tolerance_[i] = std::isinf(scale) ? scale : options.atol * scale;
      differential_[i] = system.differential(i) ? 1 : 0;
    }
  }
  ~Ida() {
    if (testing == this) testing = nullptr;
  }
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;

  static const char* name() { return "ida"; }
  /// @pre the system has started
  const char* linear_solver() const { return matrix_ ? matrix_->linear_solver() : ""; }
  double* y() { return y_.data(); }
  double* ydot() { return ydot_.data(); }

  bool start(double t0) {
    t0_ = t0;
    if (!system_.start(t0, y_.data(), ydot_.data())) return false;
    begin_y_.assign(y_.data(), y_.data() + y_.size());
    begin_ydot_.assign(ydot_.data(), ydot_.data() + ydot_.size());
    matrix_ = std::make_unique<IdaMatrix>(system_, context_, y_);
    const auto* structure = dynamic_cast<StructuredSystem*>(&system_);
    if (structure != nullptr && structure->index() == 2) {
      filtered_.emplace(system_);
      // IDA asks for this norm for error tests alone; the vectors it makes are copies of y.
      static_cast<N_Vector>(y_)->ops->nvwrmsnormmask = error_norm;
    }
    return all_finite(y_.data(), y_.size()) && all_finite(ydot_.data(), ydot_.size());
  }

  void initialise() {
    void* ida = memory_.get();
    initialised_ = true;
    check(IDASetErrHandlerFn(ida, sundials::silent, nullptr), "IDASetErrHandlerFn");
    check(IDAInit(ida, residual, t0_, y_, ydot_), "IDAInit");
    check(IDASetUserData(ida, this), "IDASetUserData");
    check(IDASVtolerances(ida, options_.rtol, tolerance_), "IDASVtolerances");
    check(IDASetId(ida, differential_), "IDASetId");
    check(IDASetSuppressAlg(ida, SUNTRUE), "IDASetSuppressAlg");
    check(IDASetLinearSolver(ida, matrix_->solver(), matrix_->matrix()), "IDASetLinearSolver");
    floor_.attach(ida, matrix_->solver(), matrix_->matrix());
    check(IDASetJacFn(ida, jacobian), "IDASetJacFn");
    check(IDASetNonlinConvCoef(ida, newton_fraction), "IDASetNonlinConvCoef");
    check(IDASetMaxErrTestFails(ida, max_error_test_failures), "IDASetMaxErrTestFails");
    check(IDASetMaxConvFails(ida, max_convergence_failures), "IDASetMaxConvFails");
    check(IDASetMaxNumSteps(ida, -1), "IDASetMaxNumSteps");
    if (options_.max_order > 0)
      check(IDASetMaxOrd(ida, std::min(options_.max_order, highest_order)), "IDASetMaxOrd");
    if (options_.max_step > 0) check(IDASetMaxStep(ida, options_.max_step), "IDASetMaxStep");
    t_end_ = t0_ + span_;
    check(IDASetStopTime(ida, t_end_), "IDASetStopTime");
    first_step_ = options_.initial_step > 0
                      ? options_.initial_step
                      : first_step_fraction * std::min(span_, system_.horizon());
    if (options_.max_step > 0) first_step_ = std::min(first_step_, options_.max_step);
    check(IDASetInitStep(ida, std::min(first_step_, span_)), "IDASetInitStep");
  }

  bool step(double& t, double end, std::string& cause) {
    const double t0 = t;
    if (end != t_end_) check(IDASetStopTime(memory_.get(), t_end_ = end), "IDASetStopTime");
    testing = this;
    evaluation_failed_ = not_finite_ = false;
    floor_.forget();
    int flag = IDASolve(memory_.get(), end, &t, y_, ydot_, IDA_ONE_STEP);
    double first_step = first_step_;
    for (int retry = 0; retry < first_step_retries && first_step_failed(flag); ++retry) {
      begin_anew(first_step *= first_step_retry);
      flag = IDASolve(memory_.get(), end, &t, y_, ydot_, IDA_ONE_STEP);
    }
    if (flag == IDA_SUCCESS || flag == IDA_TSTOP_RETURN) {
      if (!all_finite(y_.data(), y_.size())) {
        cause = "a value that is not a finite number came up";
        return false;
      }
      // A step shortened over and over before a point it cannot pass would go on without length.
      if (t < end && t - t0 < 4 * std::numeric_limits<double>::epsilon() * std::abs(t)) {
        const std::string inner = inner_cause();
        const double floor = inner.empty() ? floor_.here() : 0;
        cause = "the step became as short as the rounding of t" +
                (floor > newton_fraction ? "; " + of_rounding(floor) : inner);
        return false;
      }
      leave_order_one();
      return true;
    }
    cause = explain(flag);
    return false;
  }

  /// Begins at order 1, from y and y' as they stand.
  bool restart(double t) {
    t0_ = t;
    begin_y_.assign(y_.data(), y_.data() + y_.size());
    begin_ydot_.assign(ydot_.data(), ydot_.data() + ydot_.size());
    begin_anew(first_step_);
    return true;
  }

  bool at(double t, double* y, double* ydot) {
    if (IDAGetDky(memory_.get(), t, 0, output_) != IDA_SUCCESS)
      return std::fill_n(y, y_.size(), std::numeric_limits<double>::quiet_NaN()), false;
    std::copy_n(output_.data(), y_.size(), y);
    if (ydot == nullptr) return true;
    if (IDAGetDky(memory_.get(), t, 1, output_) != IDA_SUCCESS) return false;
    std::copy_n(output_.data(), y_.size(), ydot);
    return true;
  }

  Counters counters() {
    Counters c = earlier_attempts_;
    if (!initialised_) return c;
    add_counters(c);
    c.evaluations += floor_.evaluations();
    return c;
  }

 private:
  /// 1 tells IDA to try a shorter step.
  static int residual(double t, N_Vector y, N_Vector ydot, N_Vector r, void* self) {
    Ida& ida = *static_cast<Ida*>(self);
    double* values = N_VGetArrayPointer(r);
    const bool evaluated =
        ida.system_.residual(t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot), values);
    if (!evaluated) return ida.evaluation_failed_ = true, 1;
    if (all_finite(values, ida.y_.size())) return 0;
    ida.not_finite_ = true;
    return 1;
  }

  static int jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector, SUNMatrix matrix,
                      void* self, N_Vector, N_Vector, N_Vector) {
    Ida& ida = *static_cast<Ida*>(self);
    const IdaMatrix::Filled filled =
        ida.matrix_->fill(t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot), c, matrix);
    ida.evaluation_failed_ |= filled == IdaMatrix::Filled::not_evaluated;
    ida.not_finite_ |= filled == IdaMatrix::Filled::not_finite;
    if (ida.filtered_ && filled == IdaMatrix::Filled::yes &&
        !ida.filtered_->at(t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot), c))
      return 1;
    return filled == IdaMatrix::Filled::yes ? 0 : 1;
  }

  static double error_norm(N_Vector e, N_Vector weights, N_Vector) {
    double h = 0;
    check(IDAGetCurrentStep(testing->memory_.get(), &h), "IDAGetCurrentStep");
    return testing->filtered_->norm(N_VGetArrayPointer(e), N_VGetArrayPointer(weights), h);
  }

  bool first_step_failed(int flag) {
    if (flag != IDA_CONV_FAIL && flag != IDA_ERR_FAIL && flag != IDA_REP_RES_ERR &&
        flag != IDA_LSETUP_FAIL)
      return false;
    long steps = 1;
    check(IDAGetNumSteps(memory_.get(), &steps), "IDAGetNumSteps");
    return steps == 0;
  }

  void begin_anew(double first_step) {
    add_counters(earlier_attempts_);
    std::copy(begin_y_.begin(), begin_y_.end(), y_.data());
    std::copy(begin_ydot_.begin(), begin_ydot_.end(), ydot_.data());
    check(IDAReInit(memory_.get(), t0_, y_, ydot_), "IDAReInit");
    check(IDASetInitStep(memory_.get(), std::min(first_step, t_end_ - t0_)), "IDASetInitStep");
  }

  void add_counters(Counters& c) {
    long steps = 0, residuals = 0, setups = 0, error_failures = 0, solve_failures = 0,
         iterations = 0, jacobians = 0;
    int order = 0, next_order = 0;
    double first = 0, last = 0, next = 0, now = 0;
    void* ida = memory_.get();
    check(IDAGetIntegratorStats(ida, &steps, &residuals, &setups, &error_failures, &order,
                                &next_order, &first, &last, &next, &now),
          "IDAGetIntegratorStats");
    check(IDAGetNumNonlinSolvIters(ida, &iterations), "IDAGetNumNonlinSolvIters");
    check(IDAGetNumStepSolveFails(ida, &solve_failures), "IDAGetNumStepSolveFails");
    check(IDAGetNumJacEvals(ida, &jacobians), "IDAGetNumJacEvals");
    c.steps += steps;
    c.rejected += error_failures + solve_failures;
    c.evaluations += residuals;
    c.jacobians += jacobians;
    c.factorizations += setups;
    c.newton_iterations += iterations;
  }

  /// Holds the step for a while where order 1 is stuck; after an accepted step.
  void leave_order_one() {
    void* ida = memory_.get();
    long failures = 0;
    int order = 0;
    check(IDAGetNumErrTestFails(ida, &failures), "IDAGetNumErrTestFails");
    check(IDAGetLastOrder(ida, &order), "IDAGetLastOrder");
    stuck_ = order == 1 && failures > failures_ ? stuck_ + 1 : 0;
    failures_ = failures;
    double longest = options_.max_step;  // 0: none
    if (stuck_ == most_stuck) {
      check(IDAGetLastStep(ida, &longest), "IDAGetLastStep");
      held_ = held_steps;
      stuck_ = 0;
    } else if (held_ == 0 || (--held_ > 0 && order == 1)) {
      return;
    } else {
      held_ = 0;
    }
    check(IDASetMaxStep(ida, longest), "IDASetMaxStep");
  }

  /// Why a trial of the present step failed, if one did.
  std::string inner_cause() const {
    if (evaluation_failed_) return ": " + evaluation_cause(system_.failure());
    return not_finite_ ? ": a value that is not a finite number came up" : "";
  }

  static std::string of_rounding(double floor) {
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "%.1g", floor);
    return std::string("rounding of the state alone moves Newton's corrections by ") +
           number.data() + " tolerances";
  }

  std::string explain(int flag) const {
    const std::string inner = inner_cause();
    switch (flag) {
      case IDA_TOO_MUCH_ACC:
        return "the tolerance asks for more than double precision has";
      case IDA_ERR_FAIL:
        return "the local error stayed above its tolerance with the shortest step" + inner;
      case IDA_CONV_FAIL:
        if (floor_.reached() > 0 && inner.empty())
          return "the tolerance asks for more than double precision has: " +
                 of_rounding(floor_.reached());
        return "Newton's method did not converge with the shortest step" + inner;
      case IDA_LSETUP_FAIL:
      case IDA_LSOLVE_FAIL:
        return "the Newton matrix could not be made or factorised" + inner;
      case IDA_RES_FAIL:
      case IDA_REP_RES_ERR:
      case IDA_FIRST_RES_FAIL:
        return "the residual failed with the shortest step" + inner;
      default: {
        char* text = IDAGetReturnFlagName(flag);
        const std::string named = text != nullptr ? text : std::to_string(flag);
        std::free(text);
        return "the integrator gave up with " + named + inner;
      }
    }
  }

  /// The object whose step is under way: a norm is given vectors alone.
  static thread_local Ida* testing;

  DaeSystem& system_;
  const IntegrationOptions& options_;
  double span_, t0_ = 0, t_end_ = 0;
  double first_step_ = 0;
  std::vector<double> begin_y_, begin_ydot_;  ///< at t0_, the last beginning
  sundials::Context context_;                 // before everything made with it
  sundials::Vector y_, ydot_, output_, tolerance_, differential_;
  std::unique_ptr<IdaMatrix> matrix_;
  RoundingFloor floor_;
  std::optional<FilteredError> filtered_;
  sundials::Integrator memory_;
  Counters earlier_attempts_;
  long failures_ = 0;         ///< failed error tests
  int stuck_ = 0, held_ = 0;  ///< steps at order 1 after a rejection each; of one length, to come
  bool evaluation_failed_ = false, not_finite_ = false;  ///< in a trial of the present step
  bool initialised_ = false;
};

thread_local Ida* Ida::testing = nullptr;

}  // namespace

IntegrationResult integrate_ida(DaeSystem& system, double t0,
                                const std::vector<double>& output_times,
                                const IntegrationOptions& options, const Observer& observer) {
  expect_tolerances(options, "ida");
  const OutputCursor outputs(t0, output_times);
  Ida ida(system, options, outputs.end() - t0);
  const bool started = ida.start(t0);
  if (started && outputs.end() > t0) ida.initialise();
  return run_from_start(ida, started, system.failure(), system, t0, output_times, options,
                        observer);
}

Integrator ida_integrator() {
  return {.name = "ida",
          .takes = Integrator::Takes::dae,
          .step = Integrator::Step::adaptive,
          .multistep = true,
          .method = "IDA, BDF of orders 1 to 5",
          .dae_run = integrate_ida};
}

}  // namespace momenta
