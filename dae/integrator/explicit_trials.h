#pragma once
// Trials of one step of an explicit Runge-Kutta method: its length, whether it is accepted, its
// singularity handling, and the next length.
//
// A step taken with singularity handling cannot be more accurate than rounding in f lets it: close
// to the pose that is ε/δ, the estimate is of the size of h ε/δ, and a control that takes it for
// the method's error shortens steps without end. So where steps with singularity handling have
// become short, an estimate is held against that of a step shorter by a 64th, from a start one
// rounding away. The method's own error is nearly the same in both; if most is not, no shorter step
// is better, and the next is longer. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential
// Equations I, II.4.

#include <momenta/dae/integrator/explicit_step.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/step_control.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace momenta::explicit_rk {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

template <class Tableau>
class Trials {
 public:
  /// Trials of `step`, in a run of n unknowns over [t0, end]. All must outlive it.
  Trials(OdeSystem& system, const IntegrationOptions& options, ExplicitStep<Tableau>& step,
         std::size_t n, double t0, double end)
      : system_(system),
        options_(options),
        step_(step),
        n_(n),
        t0_(t0),
        end_(end),
        fixed_(options.step > 0) {}

  bool fixed() const { return fixed_; }  ///< steps of options.step, no error control
  SingularityHandling handling() const { return handling_; }  ///< handling of the step under way
  long evaluations() const { return again_evaluations_; }     ///< beside those of `step`

  /// The first step, after step.begin(t).
  void begin(double t) {
    if (fixed_) {
      h_ = options_.step;
      return;
    }
    if constexpr (Tableau::estimates > 0) {
      const double longest = longest_step();
      h_ = options_.initial_step > 0
               ? std::min(options_.initial_step, longest)
               : first_step(Tableau::order, system_.time_scale(), t, step_.y(),
                            step_.first_derivative(), step_.absolute_tolerance(), options_.rtol, n_,
                            longest, step_.workspace(), step_.y_new(),
                            [this](double at, const double* y, double* ydot) {
                              return step_.evaluate(at, y, ydot);
                            });
      first_ = h_;
    }
  }

  void carry_control(Memory& memory) { control_.carry(memory); }
  void carry(Memory& memory) {
    memory(h_), memory(first_), memory(handling_), memory(first_handled_), memory(lengthened_);
    memory(again_evaluations_);
  }
  /// Sets the system's handling to that of these trials.
  void set_handling() { system_.set_handling(handling_); }
  /// Lowers the handling after a step that asked for less.
  void lower_handling() {
    if (system_.wanted_handling() < handling_) take_handling(system_.wanted_handling());
  }

  /// End of the step to be tried from t, after `steps` of them; sets its length.
  double step_end(double t, long steps) {
    if (fixed_) {
      // On the grid t0 + k h, without summed rounding; the end takes the place of a point 1e-9 h
      // off.
      const double grid = t0_ + static_cast<double>(steps + 1) * options_.step;
      const bool last = grid > end_ - 1e-9 * options_.step;
      h_ = last ? end_ - t : options_.step;
      return last ? end_ : grid;
    }
    // A remainder of 1 % is not worth a step of its own.
    const double stop = options_.stop_behind(t, end_), t1 = t + 1.01 * h_ >= stop ? stop : t + h_;
    h_ = t1 - t;
    return t1;
  }

  enum class Is { accepted, rejected, failed };
  /// One trial of a step from t to t1. Rejected: to be repeated with the new length; failed: cause.
  Is attempt(double t, double t1, std::string& cause) {
    StageFailure failure = step_.attempt(t, t1, h_);
    // Once more with singularity handling: it changes f.
    if (!fixed_ && system_.wanted_handling() > handling_) {
      const bool again = system_.wanted_handling() == SingularityHandling::position;
      take_handling(system_.wanted_handling());
      if (again) failure = step_.attempt(t, t1, h_);
    }
    double error_squared = 0;
    if constexpr (Tableau::estimates > 0)
      if (!fixed_ && failure == StageFailure::none) {
        error_squared = handling_ != SingularityHandling::none ? step_.motion_error_squared()
                                                               : step_.error_squared();
        if (!std::isfinite(error_squared)) failure = StageFailure::not_finite;
      }
    if (handling_ != SingularityHandling::none && failure == StageFailure::none &&
        is_rounding(t, error_squared)) {
      if (error_squared < most_rounding) {
        lengthened_ = 0;
        h_ = std::min(2 * h_, longest_step());
        return Is::accepted;
      }
      // A stage fell upon the pose; those of a longer step are farther from it.
      if (++lengthened_ <= most_lengthened) {
        h_ = std::min(1.7 * h_, longest_step());
        return Is::rejected;
      }
    }
    if (failure == StageFailure::none && error_squared <= 1) {
      lengthened_ = 0;
      if constexpr (Tableau::estimates > 0)
        if (!fixed_) h_ = std::min(h_ * control_.accepted(error_squared), longest_step());
      return Is::accepted;
    }
    if constexpr (Tableau::estimates > 0)
      if (!fixed_) {
        h_ *= failure == StageFailure::none ? control_.rejected(error_squared) : control_.failed();
        if (h_ >= shortest_step(t)) return Is::rejected;
      }
    cause = failure_cause(failure);
    return Is::failed;
  }

 private:
  /// Part of first_handled_ below which rounding may be what makes a step short.
  static constexpr double short_step = 0.1;
  /// Squares of estimates over tolerances: below the first steps grow anyhow; above the second a
  /// stage hit a pose too closely.
  static constexpr double least_suspect = 1e-4, most_rounding = 1e4;
  static constexpr int most_lengthened = 12;  ///< trials of one step

  /// Whether an estimate is rounding for the most part.
  bool is_rounding(double t, double error_squared) {
    if constexpr (Tableau::estimates > 0) {
      if (!(h_ < short_step * first_handled_ && error_squared > least_suspect)) return false;
      if (!again_) again_.emplace(system_, options_.rtol, options_.atol, step_.y());
      for (std::size_t i = 0; i < n_; ++i)
        again_->y()[i] = step_.y()[i] * (i % 2 == 0 ? 1 + epsilon : 1 - epsilon);
      const double shorter = h_ * (1 - 1.0 / 64);
      const long before = again_->evaluations();
      const bool there =
          again_->begin(t) && again_->attempt(t, t + shorter, shorter) == StageFailure::none;
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

  std::string failure_cause(StageFailure failure) const {
    const std::string cause = failure == StageFailure::rhs ? evaluation_cause(system_.failure())
                              : failure == StageFailure::not_finite
                                  ? "a value that is not a finite number came up"
                                  : "the local error stayed above its tolerance";
    if (fixed_) return cause;
    return cause + ", also with a step of " + in_words(h_) + " s";
  }

  double longest_step() const {
    const double span = end_ - t0_;
    return options_.max_step > 0 ? std::min(options_.max_step, span) : span;
  }
  /// Step below which a stage's time differs from t in its last digits only. Near t = 0 the span
  /// counts, or, if that is long beside the motion, the first step.
  double shortest_step(double t) const {
    return 16 * epsilon * std::max(std::abs(t), std::min(1e-6 * (end_ - t0_), first_));
  }

  OdeSystem& system_;
  const IntegrationOptions& options_;
  ExplicitStep<Tableau>& step_;
  std::optional<ExplicitStep<Tableau>> again_;  ///< from a start one rounding away
  long again_evaluations_ = 0;
  StepControl<Tableau> control_;
  std::size_t n_;
  double t0_, end_;                                         ///< start and end of the run [s]
  double h_ = 0;                                            ///< step tried next [s]
  double first_ = std::numeric_limits<double>::infinity();  ///< the first that was tried [s]
  bool fixed_;
  SingularityHandling handling_ = SingularityHandling::none;
  double first_handled_ = 0;  ///< the step with which singularity handling began [s]
  int lengthened_ = 0;        ///< longer trials of this step
};

}  // namespace momenta::explicit_rk
