#pragma once
// y' = f(t, y) by explicit Runge-Kutta methods: one loop over steps for every tableau, with PI step
// control or with fixed steps (explicit_trials.h). All memory is taken before the loop.
//
// One step, in order: stages and y_new; local error; observer.step with the interpolant of this
// very step; output times inside it; after_step on y_new; output times at its end; begin_step and
// the first stage of the next. What is looked at does not change what is computed: the stages of
// dense output are extra, and f at the end serves the next step only when y was not altered in
// between. A step taken with singularity handling may be long against the distance to a singular
// pose, where no polynomial follows the motion: its samples are ends of steps of their own. Source:
// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.4-II.6, II.10.

#include <momenta/dae/integrator/explicit_trials.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/output_cursor.h>
#include <momenta/dae/integrator/stiffness.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace momenta::explicit_rk {

template <class Tableau>
class ExplicitRun {
 public:
  ExplicitRun(OdeSystem& system, double t0, const std::vector<double>& y0,
              const std::vector<double>& output_times, const IntegrationOptions& options,
              const Observer& observer)
      : system_(system),
        options_(options),
        observer_(observer),
        outputs_(t0, output_times),
        step_(system, options.rtol, options.atol, y0.data()),
        trials_(system, options, step_, y0.size(), t0, outputs_.end()),
        cpu_(options.max_cpu_seconds, options.spent_cpu_seconds),
        t_(t0),
        end_(outputs_.end()),
        sample_(y0.size()),
        corrected_(system.has_after_step()) {
    if (corrected_) unaltered_.resize(y0.size()), end_rate_.resize(y0.size());
    if (observer.sample && !trials_.fixed())
      look_.emplace(system, options.rtol, options.atol, y0.data());
    if (observer.before_step) carry_ = [this](Memory& memory) { carry(memory); };
    if (observer.step) between_ = [this](double t, double* y) { step_.interpolate(t, y); };
  }

  IntegrationResult run() {
    if (options_.carried) {
      Memory memory = *options_.carried;
      carry(memory);
    }
    trials_.set_handling();  // whatever the run before ended with
    result_.done =
        options_.carried ? steps() : sample_until(t_) && (t_ == end_ || (start() && steps()));
    if (!stopped_elsewhere_) {
      result_.end_time = t_;
      result_.y.assign(step_.y(), step_.y() + sample_.size());
    }
    result_.counters.evaluations = step_.evaluations() + trials_.evaluations();
    result_.stiff_from = stiffness_.from();
    return std::move(result_);
  }

 private:
  using Trial = typename Trials<Tableau>::Is;

  /// First stage and first step.
  bool start() {
    system_.begin_step(t_, step_.y());
    if (!step_.begin(t_)) return stop(evaluation_cause(system_.failure()));
    trials_.begin(t_);
    return true;
  }

  /// Carries the run between two steps, or two trials of one.
  void carry(Memory& memory) {
    step_.carry(memory);
    trials_.carry_control(memory);
    stiffness_.carry(memory);
    outputs_.carry(memory);
    memory(t_);
    trials_.carry(memory);
    memory(result_.counters.steps), memory(result_.counters.rejected);
    system_.carry(memory);
  }

  bool steps() {
    const bool adaptive = !trials_.fixed() && !(cpu_.seconds() > 0);  // else on to the limit
    Pace pace(result_.counters.steps + result_.counters.rejected, t_, end_, options_.max_steps);
    while (true) {
      if (carry_ && system_.can_be_put_down()) observer_.before_step(t_, carry_);
      const long attempts = result_.counters.steps + result_.counters.rejected;
      if (attempts >= options_.max_steps)
        return stop("the limit of " + std::to_string(options_.max_steps) + " steps is reached");
      if (adaptive && pace.is_hopeless(attempts, t_)) return stop(pace.in_words());
      if (cpu_.exceeded()) {
        result_.reason = time_limit_sentence(Tableau::name, cpu_.seconds(), t_);
        return false;
      }
      const double t1 = trials_.step_end(t_, result_.counters.steps);
      std::string cause;
      if (const auto is = trials_.attempt(t_, t1, cause); is != Trial::accepted) {
        ++result_.counters.rejected;
        if (is == Trial::failed) return stop(cause);
        continue;
      }
      ++result_.counters.steps;
      const bool looks = !trials_.fixed() && stiffness_.looks(result_.counters.steps);
      if (looks) step_.keep_last_stage();
      const double began = t_;
      bool altered = false;
      const bool keeps_end = this->keeps_end();
      if (keeps_end && t1 < end_) step_.have_end_derivative();
      if (!observe(t1)) return false;
      const double uncorrected = looks && corrected_ ? rate_of_change_at_end(t1) : 0;
      trials_.lower_handling();
      if (!correct(t1, altered)) return false;
      const bool kept = step_.advance(keeps_end && !altered) || step_.take_first_derivative();
      t_ = t1;
      if (!sample_until(t1 + time_tolerance(t1))) return false;
      if (t_ >= end_) return true;
      system_.begin_step(t_, step_.y());
      if (!kept && !step_.begin(t_)) return stop(evaluation_cause(system_.failure()));
      if (looks)
        stiffness_.take((t1 - began) * (altered ? uncorrected : step_.rate_of_change()), began);
      if (options_.until_stiff && !std::isnan(stiffness_.from()) && may_be_left()) {
        result_.ended_stiff = true;
        return stop("the problem is stiff");
      }
    }
  }

  /// Whether f at this step's end becomes the next first stage. It is never taken from dense
  /// output, where f may depend on the step under way (the centre of faded rows): observing a run
  /// must not change it.
  bool keeps_end() const {
    if (Tableau::end_derivative_always) return true;
    return !corrected_ && trials_.handling() == SingularityHandling::none;
  }

  /// Whether another method, which has no singularity handling, may go on with a stiff problem.
  /// Next to a singular pose this one goes on; but a pose to be passed is passed in fewer steps.
  bool may_be_left() {
    constexpr int most_waited = 1000;
    return trials_.handling() != SingularityHandling::position || ++waited_ > most_waited;
  }

  /// Steps from this step's start to t, each within the tolerance; uncounted, not corrected. False
  /// where more than a few are needed.
  bool steps_to(double t) {
    if constexpr (Tableau::estimates > 0) {
      look_->restart(step_.y());
      if (!look_->begin(t_)) return false;
      double from = t_, h = t - t_;
      for (int trials = 0; trials < 20; ++trials) {
        const bool last = from + 1.01 * h >= t;
        const double to = last ? t : from + h;
        const bool good = look_->attempt(from, to, to - from) == StageFailure::none &&
                          look_->motion_error_squared() <= 1;
        if (!good) {
          h = 0.5 * (to - from);
          continue;
        }
        if (last) {
          std::copy_n(look_->y_new(), sample_.size(), sample_.data());
          return true;
        }
        if (!look_->advance(true) && !look_->begin(to)) return false;
        from = to;
      }
    }
    return false;
  }

  /// Shows the step, then the output times inside it.
  bool observe(double t1) {
    const ObservationGuard looking(system_);
    if (observer_.step) {
      const bool go_on = observer_.step(t_, t1, between_);
      if (step_.interpolation_failed()) return stop_at_interpolation(t1);
      if (!go_on) return stop_here(t1, step_.y_new(), "the observer ended the run");
    }
    const double inside = t1 - time_tolerance(t1);
    while (!outputs_.done() && outputs_.time() < inside) {
      const double t = outputs_.time();
      outputs_.advance();
      if (!observer_.sample) continue;
      if (!(trials_.handling() != SingularityHandling::none && steps_to(t)) &&
          !step_.interpolate(t, sample_.data()))
        return stop_at_interpolation(t1);
      if (!observer_.sample(t, sample_.data(), nullptr))
        return stop_here(t, sample_.data(), "the observer ended the run");
    }
    return true;
  }

  /// |λ| at the step's end, about to be corrected: a gauge takes that farther from the last stage
  /// than their motions are. f there serves this alone and is not counted.
  double rate_of_change_at_end(double t1) {
    const ObservationGuard looking(system_);
    if (!system_.rhs(t1, step_.y_new(), end_rate_.data())) return 0;
    return step_.rate_of_change(step_.y_new(), end_rate_.data());
  }

  bool correct(double t1, bool& altered) {
    if (!corrected_) return true;
    std::copy_n(step_.y_new(), unaltered_.size(), unaltered_.data());
    if (system_.after_step(t1, step_.y_new(), altered)) return true;
    return stop_here(t1, unaltered_.data(), evaluation_cause(system_.failure()));
  }

  /// Samples output times at or before t, from the state at the step's end.
  bool sample_until(double t) {
    const ObservationGuard looking(system_);
    for (; outputs_.due(t); outputs_.advance())
      if (observer_.sample && !observer_.sample(outputs_.time(), step_.y(), nullptr)) {
        outputs_.advance();
        return stop("the observer ended the run");
      }
    return true;
  }

  /// An output time this near a step's end is that end but for rounding. On a fixed grid both are
  /// meant as multiples of the step, and 1e-9 of it is the same thing.
  double time_tolerance(double t1) const {
    return trials_.fixed() ? 1e-9 * options_.step : 4 * epsilon * std::abs(t1);
  }

  bool stop(const std::string& cause) {
    result_.reason = stop_sentence(Tableau::name, t_, cause);
    return false;
  }
  bool stop_here(double t, const double* y, const std::string& cause) {
    result_.reason = stop_sentence(Tableau::name, t, cause);
    result_.y.assign(y, y + sample_.size());
    result_.end_time = t;
    stopped_elsewhere_ = true;
    return false;
  }
  bool stop_at_interpolation(double t1) {
    return stop_here(
        t1, step_.y_new(),
        "dense output of the last step failed: " + evaluation_cause(system_.failure()));
  }

  OdeSystem& system_;
  const IntegrationOptions& options_;
  const Observer& observer_;
  OutputCursor outputs_;
  ExplicitStep<Tableau> step_;
  Trials<Tableau> trials_;
  std::optional<ExplicitStep<Tableau>> look_;  ///< for samples of steps with singularity handling
  CpuLimit cpu_;
  Interpolant between_;
  std::function<void(Memory&)> carry_;
  double t_, end_;  ///< the current step's start, the end [s]
  std::vector<double> sample_, unaltered_, end_rate_;
  Stiffness stiffness_{stability_interval<Tableau>()};
  int waited_ = 0;                  ///< stiff steps next to singular poses
  bool corrected_;                  ///< the system alters accepted states
  bool stopped_elsewhere_ = false;  ///< result_ has a time and state that are no step's start
  IntegrationResult result_;
};

}  // namespace momenta::explicit_rk
