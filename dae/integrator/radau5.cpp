// F(t, y, y') = 0 by Radau IIA, order 5, stiffly accurate: y_new satisfies F to the Newton
// tolerance, algebraic equations with it. Index up to 3.
//
// Local error and its norm: radau5_error.h. Step: options.step, without error control, where given;
// else radau5_steps.h. Gauge reset: radau5_steps.h. Newton's corrections that shrink no more are
// rounding where they leave the motion as it is. Dense output: the collocation cubic between steps;
// a sample is a step of its own from the last step's start (radau5_steps.h), or, early in a step of
// equations of higher index, from the start before; where its iteration does not converge, the
// cubic. Variables of index 3 are of order 2 in either, and the cubic's do not have the errors of
// velocities over the length of a step. Looking on counts nothing and changes nothing.
//
// Order on y, on variables of index 2, of index 3: 5, 3 in index-2 systems; 4, 3, 2 in those of
// index 3. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8, VII.4, VII.6;
// Hairer, Lubich, Roche, The Numerical Solution of Differential-Algebraic Systems by RK Methods.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/ode_restart.h>
#include <momenta/dae/integrator/output_cursor.h>
#include <momenta/dae/integrator/radau5_error.h>
#include <momenta/dae/integrator/radau5_steps.h>
#include <momenta/dae/integrator/system.h>

#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

namespace momenta {
namespace {

using namespace radau5;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double first_step_fraction = 1e-4;  ///< part of the span, as with IDA
/// Contraction of Newton's method at which derivatives serve another step.
constexpr double fast = 1e-3;
/// The gap of constraints at a step's start is divided by its length, in λ of index 3 twice: no
/// sample of higher index takes a step shorter than this part of those around it, and no last step
/// is shorter than `short_rest` of the one before.
constexpr double short_sample = 0.25, short_rest = 0.125;

class Radau5 {
 public:
  Radau5(DaeSystem& system, const IntegrationOptions& options, double span)
      : system_(system),
        gauge_(gauge_of(system)),
        options_(options),
        span_(span),
        scale_(std::min(span, system.horizon())),
        error_(system, gauge_, options, span),
        n_(static_cast<std::size_t>(system.size())),
        index_(index_of(system)),
        structure_(dynamic_cast<const StructuredSystem*>(&system)) {
    for (auto* v : {&y_, &ydot_, &y0_, &ydot0_, &earlier_y_, &earlier_ydot_}) v->resize(n_);
    for (auto* z : {&z_, &trial_, &sample_})
      for (auto& v : *z) v.resize(n_);
    if (gauge_ != nullptr) stages_in_gauge_.emplace(*gauge_);
  }

  static const char* name() { return "radau5"; }
  double* y() { return y_.data(); }
  double* ydot() { return ydot_.data(); }
  const char* linear_solver() const { return linear_solver_name(system_.pattern()); }

  bool start(double t0) {
    start_ = t1_ = t0;
    return system_.start(t0, y_.data(), ydot_.data()) && all_finite(y_.data(), n_) &&
           all_finite(ydot_.data(), n_);
  }

  void initialise() {
    stages_ = std::make_unique<Stages>(system_);
    if (structure_ != nullptr && !structure_->is_regular())
      whole_ = std::make_unique<WholeStages>(system_);
    factors_ = std::make_unique<Factors>(system_.size(), system_.pattern());
    if (options_.step > 0) {
      h_ = options_.step;
      return;
    }
    h_ = options_.initial_step > 0 ? options_.initial_step : first_step_fraction * scale_;
    h_ = std::min(h_, longest());
  }

  /// Begins from y and y' as they stand; the step is kept.
  bool restart(double) {
    first_ = changed_ = true;
    have_derivatives_ = false;
    return true;
  }

  bool step(double& t, double end, std::string& cause) {
    if (gauge_ != nullptr && gauge_->resets()) {
      if (!first_) stages_in_gauge_->shift(y_.data(), t0_, done_, y0_, z_);
      gauge_->reset(t, y_.data(), ydot_.data());
    }
    earlier_t_ = first_ ? t : t0_;
    earlier_y_.swap(y0_);
    earlier_ydot_.swap(ydot0_);
    y0_ = y_;
    ydot0_ = ydot_;
    t_ = t;
    error_.forget();
    failure_ = "the step became as short as the rounding of t";
    while (true) {
      const double t1 = step_end(t, end);
      if (options_.step > 0 && rejected_ && have_derivatives_)
        return cause = failure_ + ", with a step of " + in_words(options_.step) + " s", false;
      // The least step is rounding, unless the run ends there.
      if (h_ <= 16 * epsilon * std::max(std::abs(t), 1e-6 * scale_) && t1 < end)
        return cause = failure_ + ", also with a step of " + in_words(h_) + " s", false;
      if (!have_derivatives_ && !differentiate(t)) return cause = failure_, false;
      if (attempt(t, t1)) {
        t = t1;
        return true;
      }
      ++counters_.rejected;
    }
  }

  bool at(double t, double* y, double*) {
    for (std::size_t k = 0; k < n_; ++k) y[k] = y0_[k] + polynomial(z_, k, (t - t0_) / done_);
    return true;
  }

  bool sample(double t, double* y, double* ydot) {
    if (t >= t1_ - 4 * epsilon * std::abs(t1_)) {
      std::copy(y_.begin(), y_.end(), y);
      std::copy(ydot_.begin(), ydot_.end(), ydot);
    } else {
      const bool stepped = step_to(t, y, ydot);
      for (std::size_t k = 0; k < n_; ++k) {
        if (stepped && system_.weight(static_cast<int>(k)).power < 2) continue;
        y[k] = y0_[k] + polynomial(z_, k, (t - t0_) / done_);
        ydot[k] = slope(z_, k, (t - t0_) / done_) / done_;
      }
    }
    return true;
  }

  Counters counters() const {
    Counters c = counters_;
    if (stages_) {
      c.evaluations = stages_->evaluations;
      c.newton_iterations = stages_->iterations;
    }
    if (whole_) {
      c.evaluations += whole_->evaluations;
      c.jacobians += whole_->jacobians;
      c.factorizations += whole_->iterations;
      c.newton_iterations += whole_->iterations;
    }
    return c;
  }

 private:
  static GaugeSymmetry* gauge_of(DaeSystem& system) {
    auto* gauge = dynamic_cast<GaugeSymmetry*>(&system);
    return gauge != nullptr && gauge->impulse_count() > 0 ? gauge : nullptr;
  }

  /// Index as far as weights tell it. Multipliers in no norm are one worse than what it sees; alone
  /// they are told from q and u, and do not count.
  static int index_of(const DaeSystem& system) {
    int most = 0, least = 0;
    for (int k = 0; k < system.size(); ++k) {
      const int power = system.weight(k).power;
      most = std::max(most, power), least = std::min(least, power);
    }
    return most > 0 ? 1 + most - least : 1;
  }

  double longest() const { return options_.max_step > 0 ? options_.max_step : span_; }

  double step_end(double t, double end) {
    if (options_.step > 0) {
      const FixedGrid grid(start_, options_.step);
      double t1 = grid.next(counters_.steps, end);
      if (index_ > 1 && end - t1 < short_rest * options_.step) t1 = end;
      changed_ |= grid.length(t, t1) != h_;
      h_ = grid.length(t, t1);
      return t1;
    }
    double t1 = t + h_;
    if (t + 1.01 * h_ >= end)
      t1 = end;
    else if (index_ > 1 && t + (1 + short_rest) * h_ > end)
      t1 = t + 0.5 * (end - t);
    if (t1 != t + h_) changed_ = true;
    if (t1 == end || t1 != t + h_) h_ = t1 - t;
    return t1;
  }

  bool differentiate(double t) {
    ++counters_.jacobians;
    have_factors_ = false;
    have_derivatives_ = stages_->differentiate(t, y0_.data(), ydot0_.data(), gamma / h_);
    derivatives_fresh_ = have_derivatives_;
    if (!have_derivatives_) failure_ = evaluation_cause(system_.failure());
    return have_derivatives_;
  }

  /// One trial. False: sets h_ and what to make anew.
  bool attempt(double t, double t1) {
    if (changed_ || !have_factors_) {
      counters_.factorizations += 2;
      if (!stages_->factor(*factors_, h_)) return fail("the Newton matrix is singular", 0.5);
      have_factors_ = true;
      changed_ = false;
    }
    const WeightedNorm& norm = error_.norm(y0_.data(), h_);
    guess(trial_, h_);
    const int most = options_.step > 0 ? patient_iterations : Prediction::most_iterations;
    const StepStart start{t_, y0_.data(), ydot0_.data()};
    const Outcome outcome =
        whole_
            ? whole_->solve(t, h_, gamma / h_, y0_.data(), norm, error_.fraction(), trial_)
            : stages_->solve(*factors_, t, h_, y0_.data(), norm, error_.fraction(), most, trial_);
    switch (outcome) {
      case Outcome::converged:
        break;
      case Outcome::slow:
      case Outcome::diverged:
        if (!whole_ && error_.rounding_is_left(*stages_, start)) break;
        return fail("Newton's method did not converge", 0.5);
      case Outcome::evaluation_failed:
        return fail(evaluation_cause(system_.failure()), 0.25);
      case Outcome::not_finite:
        return fail("a value that is not a finite number came up", 0.25);
    }
    const double error =
        options_.step > 0 ? 0
                          : error_.of(*stages_, *factors_, start, h_, trial_, first_ || rejected_);
    if (!std::isfinite(error)) return fail("a value that is not a finite number came up", 0.25);
    const double by_error = Prediction::divisor(error, whole_ ? 1 : stages_->count);
    if (error >= 1)
      return fail("the local error stayed above its tolerance", first_ ? 0.1 : 1 / by_error);
    accept(t, t1, error, by_error);
    return true;
  }

  bool fail(std::string cause, double factor) {
    failure_ = std::move(cause);
    h_ *= factor;
    changed_ = rejected_ = true;
    // Derivatives from an earlier step may be to blame.
    if (!derivatives_fresh_) have_derivatives_ = false;
    return false;
  }

  void accept(double t, double t1, double error, double by_error) {
    ++counters_.steps;
    error_.passed(h_);
    std::swap(z_, trial_);
    t0_ = t, t1_ = t1, done_ = h_;
    for (std::size_t k = 0; k < n_; ++k) y_[k] = y0_[k] + z_[2][k];
    stages_->rate(2, h_, z_, ydot_.data());
    const double factor = control_.factor(h_, error, by_error, first_, rejected_);
    have_derivatives_ = !whole_ && stages_->theta <= fast;
    derivatives_fresh_ = false;
    if (options_.step > 0) {
      first_ = false;
      return;
    }
    if (!(have_derivatives_ && Prediction::keeps(factor))) {
      h_ = std::min(h_ * factor, longest());
      changed_ = true;
    }
    first_ = rejected_ = false;
  }

  /// Guesses stages of the next step, of length h, by the last step's polynomial; before the first
  /// step by a straight line.
  void guess(StageValues& z, double h) const {
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        z[i][k] =
            first_ ? c[i] * h * ydot0_[k] : polynomial(z_, k, 1 + c[i] * h / done_) - z_[2][k];
  }

  /// Steps to a time inside the last step, from its start or the one before; false where there is
  /// none, or where it does not converge.
  bool step_to(double t, double* y, double* ydot) {
    const double before = t0_ - earlier_t_;
    const bool early =
        index_ > 1 && t - t0_ < short_sample * (before > 0 ? std::min(before, done_) : done_);
    if (early && !(before > 0)) return false;
    const double from = early ? earlier_t_ : t0_, h = t - from;
    const std::vector<double>&start = early ? earlier_y_ : y0_,
          &rate = early ? earlier_ydot_ : ydot0_;
    if (h <= 4 * epsilon * std::max(std::abs(from), 1e-6 * scale_)) {
      std::copy(start.begin(), start.end(), y);
      std::copy(rate.begin(), rate.end(), ydot);
      return true;
    }
    if (!look_) look_ = std::make_unique<Look>(system_, whole_ != nullptr);
    error_.forget();
    const WeightedNorm& norm = error_.norm(start.data(), h);
    error_.forget();
    // The cubic, and that of the step before: the trial of this step has left its stages.
    for (std::size_t i = 0; i < 3; ++i) {
      const double part = (early ? from - t0_ : 0) / done_ + c[i] * h / done_;
      for (std::size_t k = 0; k < n_; ++k)
        sample_[i][k] = part < 0 ? polynomial(trial_, k, c[i] * h / before)
                                 : y0_[k] - start[k] + polynomial(z_, k, part);
    }
    return (*look_)(from, h, gamma / done_, start.data(), rate.data(), norm, error_.fraction(),
                    sample_, y, ydot);
  }

  DaeSystem& system_;
  GaugeSymmetry* gauge_;  ///< null: none
  std::optional<StagesInGauge> stages_in_gauge_;
  const IntegrationOptions& options_;
  double span_, scale_;  ///< [s]; steps at a start are parts of the scale
  LocalError error_;
  Prediction control_;
  std::size_t n_;
  int index_;
  const StructuredSystem* structure_;  ///< null: not known
  std::unique_ptr<Stages> stages_;
  std::unique_ptr<Factors> factors_;
  std::unique_ptr<Look> look_;                    ///< null until used
  std::unique_ptr<WholeStages> whole_;            ///< null: simplified iterations
  std::vector<double> y_, ydot_, y0_, ydot0_;     ///< at the step's end and start
  std::vector<double> earlier_y_, earlier_ydot_;  ///< at the start of the step before
  StageValues z_, trial_, sample_;
  double start_ = 0;                   ///< start of the run [s]
  double t_ = 0;                       ///< start of the step under way [s]
  double t0_ = 0, t1_ = 0, done_ = 0;  ///< the last step [s]
  double earlier_t_ = 0;               ///< start of the step before; t0_: there is none
  double h_ = 0;                       ///< next trial [s]
  bool first_ = true, rejected_ = false;
  bool changed_ = true;  ///< h_ is not the factors' step
  bool have_derivatives_ = false, derivatives_fresh_ = false, have_factors_ = false;
  std::string failure_;
  Counters counters_;
};

}  // namespace

IntegrationResult integrate_radau5(DaeSystem& system, double t0,
                                   const std::vector<double>& output_times,
                                   const IntegrationOptions& options, const Observer& observer) {
  expect_tolerances(options, "radau5");
  const OutputCursor outputs(t0, output_times);
  Radau5 radau(system, options, outputs.end() - t0);
  const bool started = radau.start(t0);
  if (started && outputs.end() > t0) radau.initialise();
  return run_from_start(radau, started, system.failure(), system, t0, output_times, options,
                        observer);
}

Integrator radau5_integrator() {
  return {.name = "radau5",
          .takes = Integrator::Takes::dae,
          .step = Integrator::Step::adaptive,
          .method = "Radau IIA, order 5",
          .resets = true,
          .dae_run = integrate_radau5};
}

}  // namespace momenta
