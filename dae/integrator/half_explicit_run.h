#pragma once
// The loop over steps of half-explicit Runge-Kutta methods for y' = f(t, y, z), 0 = g(t, y) of
// index 2: step control, samples, gauge. Each method has its stages in its own file.
//
// A step begins with k_1 = f(t, y_0, z_0) of the end of the step before and ends, behind the last
// stage, with z and f at (t_1, y_1) by the hidden constraint: z at a step's end is of the order of
// y. Gauge reset: σ leaves p before each step, which is a step from another y_0 of the same motion.
// Quaternions return to unit length after a step; inside it they move as the equations move them.
// Inside steps y is the method's dense output, where it has one, z and f by the hidden constraint.
// Where it has none, it is Hermite's cubic, and a sample is a step of its own from the step's
// start, of full order and on the constraint; where that fails, the cubic. Step: options.step,
// without error control, where given; else PI control by the method's tableau.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/aligned_array.h>
#include <momenta/dae/integrator/gauge_symmetry.h>
#include <momenta/dae/integrator/half_explicit.h>
#include <momenta/dae/integrator/half_explicit_error.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/ode_restart.h>
#include <momenta/dae/integrator/output_cursor.h>
#include <momenta/dae/integrator/step_control.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace momenta {

struct HalfExplicitState {
  explicit HalfExplicitState(std::size_t size)
      : y(explicit_rk::padded(size)), ydot(explicit_rk::padded(size)) {}
  explicit_rk::AlignedArray y, ydot;  ///< (y, z) and its rate; that of z is left at zero. Padded:
                                      ///< stages are summed over whole cache lines
};

/// `Stages`, for one step:
///   name; first_step, a part of the span; Control, a tableau with exponents of step control
///   Stages(HalfExplicit&)
///   bool step(t, h, t1, from, to, counters)   (y_1, z) of `to` from `from`, g(t_1, y_1) = 0
///   double error(from, to, h, measure)        square of the local error over its tolerance;
///                                             `to` has its rates
/// and where it has dense output, from accepted steps alone
///   bool between(t, h, t1, fraction, from, to, y)
template <class Stages>
class HalfExplicitRun {
 public:
  HalfExplicitRun(DaeSystem& system, HalfExplicit& parts, double t0, double span,
                  const IntegrationOptions& options)
      : system_(system),
        parts_(parts),
        gauge_(dynamic_cast<GaugeSymmetry*>(&system)),
        options_(options),
        measure_(system, parts, gauge_, options),
        grid_(t0, options.step),
        stages_(parts),
        n_(static_cast<std::size_t>(parts.differential_unknowns())),
        size_(n_ + static_cast<std::size_t>(parts.multipliers())),
        old_(size_),
        now_(size_),
        look_(size_),
        span_(span),
        scale_(std::min(span, system.horizon())),
        t0_(t0),
        t1_(t0) {}

  static const char* name() { return Stages::name; }
  static constexpr bool takes_start = true;  ///< f at a step's start is a stage
  double* y() { return now_.y.data(); }
  double* ydot() { return now_.ydot.data(); }
  const Counters& counters() const { return counters_; }
  const std::string& failure() const { return cause_; }

  bool start() {
    if (!system_.start(t0_, now_.y.data(), now_.ydot.data())) {
      cause_ = system_.failure();
      return false;
    }
    ++counters_.evaluations;
    if (!parts_.consistent(t0_, now_.y.data(), now_.y.data() + n_, now_.ydot.data())) {
      cause_ = parts_.half_explicit_failure();
      return false;
    }
    std::copy_n(now_.y.data(), size_, old_.y.data());
    std::copy_n(now_.ydot.data(), size_, old_.ydot.data());
    const double longest = options_.max_step > 0 ? options_.max_step : span_;
    h_ = options_.step > 0           ? options_.step
         : options_.initial_step > 0 ? options_.initial_step
                                     : Stages::first_step * scale_;
    h_ = options_.step > 0 ? h_ : std::min(h_, longest);
    return finite(now_);
  }

  /// Begins from y, z and y' as they stand; the step is kept.
  bool restart(double) {
    control_ = {};
    measure_.restart();
    return true;
  }

  bool step(double& t, double end, std::string& cause) {
    const bool fixed = options_.step > 0;
    if (gauge_ != nullptr && gauge_->resets()) gauge_->reset(t, now_.y.data(), now_.ydot.data());
    swap();
    while (true) {
      const double t1 = step_end(t, end);
      const double h = fixed ? h_ : t1 - t;
      double squares = 0;
      bool good = advance(t, h, t1, old_, now_, counters_) && finite(now_);
      if (good && !fixed) {
        measure_.at(t, old_.y.data(), old_.ydot.data(), h);
        squares = stages_.error(old_, now_, h, measure_);
        good = std::isfinite(squares);
      }
      if (good && squares <= 1) {
        ++counters_.steps;
        if (!fixed) {
          h_ = h * control_.accepted(squares);
          if (options_.max_step > 0) h_ = std::min(h_, options_.max_step);
        }
        measure_.accept();
        t0_ = t, t1_ = t1;
        t = t1;
        return true;
      }
      ++counters_.rejected;
      if (good) cause_ = "the local error stayed above its tolerance";
      if (!fixed) h_ = h * (good ? control_.rejected(squares) : control_.failed());
      if (fixed || h_ < 16 * epsilon * std::max(std::abs(t), 1e-6 * scale_)) {
        swap();
        cause =
            cause_ + (fixed ? ", with a step of " : ", also with a step of ") + in_words(h_) + " s";
        if (const std::string why = parts_.dependent(t, now_.y.data()); !why.empty())
          cause += ": " + why;
        return false;
      }
    }
  }

  bool at(double t, double* y, double*) {
    if constexpr (dense) {
      if (inside(t)) return std::copy_n(look_.y.data(), size_, y), true;
    }
    cubic(t, y);
    return true;
  }

  bool sample(double t, double* y, double* ydot) {
    const double apart = options_.step > 0 ? grid_.tolerance() : 4 * epsilon * std::abs(t1_);
    const HalfExplicitState* found = &look_;
    if (t1_ - t <= apart) {
      found = &now_;
    } else if (t - t0_ <= apart) {
      found = &old_;
    } else if (!inside(t)) {
      cubic(t, look_.y.data());
      std::copy_n(old_.ydot.data(), size_, look_.ydot.data());
    }
    std::copy_n(found->y.data(), size_, y);
    std::copy_n(found->ydot.data(), size_, ydot);
    return true;
  }

 private:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  static constexpr bool dense =
      requires(Stages & stages, const HalfExplicitState& state, double* y) {
    stages.between(0.0, 0.0, 0.0, 0.0, state, state, y);
  };

  /// (y, z) and its rate at t inside the last step, on the constraint, into look_.
  bool inside(double t) {
    if constexpr (dense) {
      std::copy_n(old_.y.data(), size_, look_.y.data());
      return stages_.between(t0_, t1_ - t0_, t1_, (t - t0_) / (t1_ - t0_), old_, now_,
                             look_.y.data()) &&
             parts_.meet(t, look_.y.data()) && ended(t, look_) && finite(look_);
    } else {
      Counters uncounted;
      return advance(t0_, t - t0_, t, old_, look_, uncounted) && finite(look_);
    }
  }
  /// Hermite's cubic for y; z along a line.
  void cubic(double t, double* y) const {
    const double h = t1_ - t0_, x = (t - t0_) / h;
    for (std::size_t i = 0; i < size_; ++i) {
      const double from = old_.y[i], to = now_.y[i];
      y[i] = from + x * (to - from);
      if (i < n_)
        y[i] += x * (x - 1) *
                ((1 - 2 * x) * (to - from) + h * ((x - 1) * old_.ydot[i] + x * now_.ydot[i]));
    }
  }

  void swap() {
    old_.y.swap(now_.y);
    old_.ydot.swap(now_.ydot);
  }

  double step_end(double t, double end) {
    if (options_.step > 0) {
      const double t1 = grid_.next(counters_.steps, end);
      h_ = grid_.length(t, t1);
      return t1;
    }
    return t + 1.01 * h_ >= end ? end : t + h_;
  }

  bool finite(const HalfExplicitState& state) {
    if (all_finite(state.y.data(), size_) && all_finite(state.ydot.data(), size_)) return true;
    cause_ = "a value that is not a finite number came up";
    return false;
  }

  /// One step from `from` at t over h to t1.
  bool advance(double t, double h, double t1, const HalfExplicitState& from, HalfExplicitState& to,
               Counters& counters) {
    if (!stages_.step(t, h, t1, from, to, counters)) return failed();
    ++counters.evaluations;
    return ended(t1, to) || failed();
  }
  /// z and f at y.
  bool ended(double t, HalfExplicitState& state) {
    parts_.normalise(state.y.data());
    return parts_.consistent(t, state.y.data(), state.y.data() + n_, state.ydot.data());
  }
  bool failed() {
    cause_ = parts_.half_explicit_failure();
    return false;
  }

  DaeSystem& system_;
  HalfExplicit& parts_;
  GaugeSymmetry* gauge_;  ///< null: none
  const IntegrationOptions& options_;
  HalfExplicitError measure_;
  FixedGrid grid_;
  Stages stages_;
  explicit_rk::StepControl<typename Stages::Control> control_;
  std::size_t n_, size_;  ///< size of y; of (y, z)
  HalfExplicitState old_, now_, look_;
  double span_, scale_, h_ = 0;  ///< [s]; steps at a start are parts of the scale
  double t0_, t1_;               ///< the last step [s]
  std::string cause_;
  Counters counters_;
};

/// @throws std::invalid_argument for systems that are not HalfExplicit, steps and tolerances that
/// are not positive.
template <class Stages>
IntegrationResult integrate_half_explicit(DaeSystem& system, double t0,
                                          const std::vector<double>& output_times,
                                          const IntegrationOptions& options,
                                          const Observer& observer) {
  auto* parts = dynamic_cast<HalfExplicit*>(&system);
  if (parts == nullptr)
    throw std::invalid_argument(
        std::string(Stages::name) +
        " takes equations of index 2: expected form acceleration-index2 or momentum-index2");
  if (!(options.step >= 0) || !std::isfinite(options.step))
    throw std::invalid_argument("a fixed step must be positive");
  expect_tolerances(options, Stages::name);
  const OutputCursor outputs(t0, output_times);
  HalfExplicitRun<Stages> method(system, *parts, t0, outputs.end() - t0, options);
  const bool started = method.start();
  return run_from_start(method, started, method.failure(), system, t0, output_times, options,
                        observer);
}

}  // namespace momenta
