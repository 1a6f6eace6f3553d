#pragma once
// y' = f(t, y) by explicit Runge-Kutta methods: one loop over steps for every tableau, with PI step
// control or with fixed steps. All memory is taken before the loop.
//
// One step, in order: stages and y_new; local error; observer.step with the interpolant of this
// very step; output times inside it; after_step on y_new; output times at its end; begin_step and
// the first stage of the next. What is looked at does not change what is computed: the stages of
// dense output are extra, and f at the end serves the next step only when y was not altered in
// between. A step taken with singularity handling may be long against the distance to a singular
// pose, where no polynomial follows the motion: its samples are ends of steps of their own. Nor can
// such a step be more accurate than rounding in f lets it: close to the pose that is ε/δ, the
// estimate is of the size of h ε/δ, and a control that takes it for the method's error shortens
// steps without end. So where steps with singularity handling have become short, an estimate is
// held against that of a step shorter by a 64th, from a start one rounding away. The method's own
// error is nearly the same in both; if most is not, no shorter step is better, and the next is
// longer. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.4-II.6,
// II.10.

#include <momenta/dae/solver/explicit_step.h>
#include <momenta/dae/solver/first_step.h>
#include <momenta/dae/solver/integration.h>
#include <momenta/dae/solver/output_cursor.h>
#include <momenta/dae/solver/step_control.h>
#include <momenta/dae/solver/stiffness.h>
#include <momenta/dae/solver/stopping.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace momenta::explicit_rk {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

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
        cpu_(options.max_cpu_seconds, options.spent_cpu_seconds),
        t0_(t0),
        t_(t0),
        end_(outputs_.end()),
        fixed_(options.step > 0),
        sample_(y0.size()),
        corrected_(system.has_after_step()) {
    if (corrected_) unaltered_.resize(y0.size()), end_rate_.resize(y0.size());
    if (observer.sample && !fixed_) look_.emplace(system, options.rtol, options.atol, y0.data());
    if (observer.before_step) carry_ = [this](Memory& memory) { carry(memory); };
    if (observer.step) between_ = [this](double t, double* y) { step_.interpolate(t, y); };
  }

  IntegrationResult run() {
    if (options_.carried) {
      Memory memory = *options_.carried;
      carry(memory);
    }
    system_.set_handling(handling_);  // whatever the run before this one ended with
    result_.done =
        options_.carried ? steps() : sample_until(t_) && (t_ == end_ || (start() && steps()));
    if (!stopped_elsewhere_) {
      result_.end_time = t_;
      result_.y.assign(step_.y(), step_.y() + sample_.size());
    }
    result_.counters.evaluations = step_.evaluations() + again_evaluations_;
    result_.stiff_from = stiffness_.from();
    return std::move(result_);
  }

 private:
  /// A step with singularity handling below this part of the first one may be short because of
  /// rounding.
  static constexpr double short_step = 0.1;
  /// Squares of estimates over tolerances: below the first steps grow anyhow; above the second
  /// a pose was hit too closely.
  static constexpr double least_suspect = 1e-4, most_rounding = 1e4;
  static constexpr int most_lengthened = 12;  ///< trials of one step

  /// First stage and first step.
  bool start() {
    system_.begin_step(t_, step_.y());
    if (!step_.begin(t_)) return stop(evaluation_cause(system_.failure()));
    if (fixed_) {
      h_ = options_.step;
      return true;
    }
    if constexpr (Tableau::estimates > 0) {
      const double longest = longest_step();
      h_ = options_.initial_step > 0
               ? std::min(options_.initial_step, longest)
               : first_step(Tableau::order, t_, step_.y(), step_.first_derivative(),
                            step_.absolute_tolerance(), options_.rtol, sample_.size(), longest,
                            step_.workspace(), step_.y_new(),
                            [this](double t, const double* y, double* ydot) {
                              return step_.evaluate(t, y, ydot);
                            });
    }
    return true;
  }

  /// Between two steps, or two trials of one.
  void carry(Memory& memory) {
    step_.carry(memory);
    control_.carry(memory);
    stiffness_.carry(memory);
    outputs_.carry(memory);
    memory(t_), memory(h_), memory(handling_), memory(first_handled_), memory(lengthened_);
    memory(again_evaluations_);
    memory(result_.counters.steps), memory(result_.counters.rejected);
    system_.carry(memory);
  }

  bool steps() {
    while (true) {
      if (carry_ && system_.can_be_put_down()) observer_.before_step(t_, carry_);
      const long attempts = result_.counters.steps + result_.counters.rejected;
      if (attempts >= options_.max_steps)
        return stop("the limit of " + std::to_string(options_.max_steps) + " steps is reached");
      if (cpu_.exceeded()) {
        result_.reason = time_limit_sentence(Tableau::name, cpu_.seconds(), t_);
        return false;
      }
      const double t1 = step_end();
      if (!attempt(t1)) {
        if (!result_.reason.empty()) return false;
        continue;
      }
      ++result_.counters.steps;
      const bool looks = !fixed_ && stiffness_.looks(result_.counters.steps);
      if (looks) step_.keep_last_stage();
      const double began = t_;
      bool altered = false;
      const bool keeps_end = this->keeps_end();
      if (keeps_end && t1 < end_) step_.have_end_derivative();
      if (!observe(t1)) return false;
      const double uncorrected = looks && corrected_ ? rate_of_change_at_end(t1) : 0;
      if (system_.wanted_handling() < handling_) take_handling(system_.wanted_handling());
      if (!correct(t1, altered)) return false;
      const bool kept = step_.advance(keeps_end && !altered) || step_.take_first_derivative();
      t_ = t1;
      if (!sample_until(t1 + time_tolerance(t1))) return false;
      if (t_ >= end_) return true;
      system_.begin_step(t_, step_.y());
      if (!kept && !step_.begin(t_)) return stop(evaluation_cause(system_.failure()));
      if (!looks) continue;
      stiffness_.take((t1 - began) * (altered ? uncorrected : step_.rate_of_change()), began);
      if (options_.until_stiff && handling_ == SingularityHandling::none &&
          !std::isnan(stiffness_.from())) {
        result_.ended_stiff = true;
        return stop("the problem is stiff");
      }
    }
  }

  /// Whether f at this step's end becomes the next first stage. It is evaluated before anyone looks
  /// and never taken from dense output, which would be another f wherever f depends on the step
  /// under way (what faded rows are centred on): observing a run must not change it.
  bool keeps_end() const {
    if (Tableau::end_derivative_always) return true;
    return !corrected_ && handling_ == SingularityHandling::none;
  }

  /// Where the step to be tried ends; sets h_ to the distance.
  double step_end() {
    if (fixed_) {
      // On the grid t0 + k h, without summed rounding; the end takes the place of a point 1e-9 h
      // off.
      const double grid = t0_ + static_cast<double>(result_.counters.steps + 1) * options_.step;
      const bool last = grid > end_ - 1e-9 * options_.step;
      h_ = last ? end_ - t_ : options_.step;
      return last ? end_ : grid;
    }
    // A remainder of 1 % is not worth a step of its own.
    const double t1 = t_ + 1.01 * h_ >= end_ ? end_ : t_ + h_;
    h_ = t1 - t_;
    return t1;
  }

  /// One trial of a step to t1. False: repeat with the new h_, or, with a reason set, stop.
  bool attempt(double t1) {
    StageFailure failure = step_.attempt(t_, t1, h_);
    // Once more with singularity handling: f differs there from what these stages were.
    if (!fixed_ && system_.wanted_handling() > handling_) {
      const bool again = system_.wanted_handling() == SingularityHandling::position;
      take_handling(system_.wanted_handling());
      if (again) failure = step_.attempt(t_, t1, h_);
    }
    double error_squared = 0;
    if constexpr (Tableau::estimates > 0)
      if (!fixed_ && failure == StageFailure::none) {
        error_squared = handling_ != SingularityHandling::none ? step_.motion_error_squared()
                                                               : step_.error_squared();
        if (!std::isfinite(error_squared)) failure = StageFailure::not_finite;
      }
    if (handling_ != SingularityHandling::none && failure == StageFailure::none &&
        is_rounding(error_squared)) {
      if (error_squared < most_rounding) {
        lengthened_ = 0;
        h_ = std::min(2 * h_, longest_step());
        return true;
      }
      // A stage fell upon the pose. Those of a longer step are farther from it.
      if (++lengthened_ <= most_lengthened) {
        ++result_.counters.rejected;
        h_ = std::min(1.7 * h_, longest_step());
        return false;
      }
    }
    if (failure == StageFailure::none && error_squared <= 1) {
      lengthened_ = 0;
      if constexpr (Tableau::estimates > 0)
        if (!fixed_) h_ = std::min(h_ * control_.accepted(error_squared), longest_step());
      return true;
    }
    ++result_.counters.rejected;
    if constexpr (Tableau::estimates > 0)
      if (!fixed_) {
        h_ *= failure == StageFailure::none ? control_.rejected(error_squared) : control_.failed();
        if (h_ >= shortest_step()) return false;
      }
    return stop(failure_cause(failure));
  }

  /// Whether an estimate is rounding for the most part.
  bool is_rounding(double error_squared) {
    if constexpr (Tableau::estimates > 0) {
      if (!(h_ < short_step * first_handled_ && error_squared > least_suspect)) return false;
      if (!again_) again_.emplace(system_, options_.rtol, options_.atol, step_.y());
      for (std::size_t i = 0; i < sample_.size(); ++i)
        again_->y()[i] = step_.y()[i] * (i % 2 == 0 ? 1 + epsilon : 1 - epsilon);
      const double shorter = h_ * (1 - 1.0 / 64);
      const long before = again_->evaluations();
      const bool there =
          again_->begin(t_) && again_->attempt(t_, t_ + shorter, shorter) == StageFailure::none;
      again_evaluations_ += again_->evaluations() - before;
      if (!there) return false;
      again_->subtract_stages(step_);
      return again_->motion_error_squared() > 0.25 * error_squared;
    }
    return false;
  }

  void take_handling(SingularityHandling handling) {
    if (handling_ == SingularityHandling::none) first_handled_ = h_;
    handling_ = handling;
    system_.set_handling(handling);
  }

  /// Steps of their own from this one's start to t, each within the tolerance; uncounted, and not
  /// corrected. False where more than a few are needed.
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

  std::string failure_cause(StageFailure failure) const {
    const std::string cause = failure == StageFailure::rhs ? evaluation_cause(system_.failure())
                              : failure == StageFailure::not_finite
                                  ? "a value that is not a finite number came up"
                                  : "the local error stayed above its tolerance";
    if (fixed_) return cause;
    return cause + ", also with a step of " + in_words(h_) + " s";
  }

  /// Shows the step, then the output times inside it.
  bool observe(double t1) {
    const Looking looking(system_);
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
      if (!(handling_ != SingularityHandling::none && steps_to(t)) &&
          !step_.interpolate(t, sample_.data()))
        return stop_at_interpolation(t1);
      if (!observer_.sample(t, sample_.data(), nullptr))
        return stop_here(t, sample_.data(), "the observer ended the run");
    }
    return true;
  }

  /// |λ| at the step's end, which is about to be corrected: what a gauge makes of it is farther
  /// from the last stage than their motions are. f there serves this alone and is not counted.
  double rate_of_change_at_end(double t1) {
    const Looking looking(system_);
    if (!system_.rhs(t1, step_.y_new(), end_rate_.data())) return 0;
    return step_.rate_of_change(step_.y_new(), end_rate_.data());
  }

  bool correct(double t1, bool& altered) {
    if (!corrected_) return true;
    std::copy_n(step_.y_new(), unaltered_.size(), unaltered_.data());
    if (system_.after_step(t1, step_.y_new(), altered)) return true;
    return stop_here(t1, unaltered_.data(), evaluation_cause(system_.failure()));
  }

  /// Output times at or before t, from the state at the step's end.
  bool sample_until(double t) {
    const Looking looking(system_);
    for (; outputs_.due(t); outputs_.advance())
      if (observer_.sample && !observer_.sample(outputs_.time(), step_.y(), nullptr)) {
        outputs_.advance();
        return stop("the observer ended the run");
      }
    return true;
  }

  /// An output time this near a step's end is that end: rounding of the times, no more. On a fixed
  /// grid both are meant as multiples of the step, and 1e-9 of it is the same thing.
  double time_tolerance(double t1) const {
    return fixed_ ? 1e-9 * options_.step : 4 * epsilon * std::abs(t1);
  }
  double longest_step() const {
    const double span = end_ - t0_;
    return options_.max_step > 0 ? std::min(options_.max_step, span) : span;
  }
  /// Below this a stage's time differs from t in its last digits only; near t = 0 the span counts.
  double shortest_step() const {
    return 16 * epsilon * std::max(std::abs(t_), 1e-6 * (end_ - t0_));
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
  std::optional<ExplicitStep<Tableau>> look_;   ///< for samples of steps with singularity handling
  std::optional<ExplicitStep<Tableau>> again_;  ///< from a start one rounding away
  long again_evaluations_ = 0;                  ///< of those
  StepControl<Tableau> control_;
  CpuLimit cpu_;
  Interpolant between_;
  std::function<void(Memory&)> carry_;
  double t0_, t_, end_;  ///< start, current step's start, end [s]
  double h_ = 0;         ///< step tried next [s]
  bool fixed_;           ///< steps of options.step, no error control
  std::vector<double> sample_, unaltered_, end_rate_;
  Stiffness stiffness_{stability_interval<Tableau>()};
  SingularityHandling handling_ = SingularityHandling::none;  ///< of the step under way
  double first_handled_ = 0;        ///< the step with which singularity handling began [s]
  int lengthened_ = 0;              ///< trials of this step
  bool corrected_;                  ///< the system alters accepted states
  bool stopped_elsewhere_ = false;  ///< result_ has a time and state that are no step's start
  IntegrationResult result_;
};

}  // namespace momenta::explicit_rk
