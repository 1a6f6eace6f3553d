// F(t, y, y') = 0 by the backward differentiation formulas of orders 1 to 5 with variable step
// (bdf_step.h), on past values whose gauge can be changed.
//
// Order and step from E_j = ‖h^(j+1) y^(j+1)‖ over the tolerance, j = k − 2 … k + 1, as DASSL has
// it: the order falls to k − 1 where E_{k−1} and E_{k−2} are no more than E_k; after k + 1 equal
// steps it rises where E_{k+1} < E_k < E_{k−1}. The next step is h (2 E_j/(j + 1) +
// 10⁻⁴)^(−1/(j+1)), taken if it is less, or more by a share that pays for a new matrix. At the
// start order and step rise with each step until the error says otherwise. Multipliers are in no
// norm. Long runs: local_newton.h.
//
// Dense output: the polynomial through the newest values. Past singular poses: ode_restart.h.
// Source: Brenan, Campbell, Petzold, Numerical Solution of Initial-Value Problems in
// Differential-Algebraic Equations, ch. 5; Hindmarsh et al., ACM TOMS 31 (2005) 363-396.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/bdf_step.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/integrator/ode_restart.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace momenta {
namespace {

class Bdf5 {
 public:
  Bdf5(DaeSystem& system, const IntegrationOptions& options, double span)
      : system_(system),
        options_(options),
        span_(span),
        scale_(std::min(span, system.horizon())),
        share_(span, options.rtol) {
    y_.resize(static_cast<std::size_t>(system.size()));
    ydot_.resize(y_.size());
    if (options.max_order > 0) highest_ = std::min(highest_, options.max_order);
  }

  static const char* name() { return "bdf5"; }
  double* y() { return y_.data(); }
  double* ydot() { return ydot_.data(); }
  const char* linear_solver() const { return step_ ? step_->linear_solver() : ""; }
  Counters counters() const {
    Counters all = counters_;
    if (step_) all += step_->counters();
    return all;
  }

  bool start(double t0) {
    if (!system_.start(t0, y_.data(), ydot_.data())) return false;
    if (!all_finite(y_.data(), y_.size()) || !all_finite(ydot_.data(), y_.size())) return false;
    step_ = std::make_unique<BdfStep>(system_, options_.rtol, options_.atol);
    return restart(t0);
  }

  /// Begins at order 1, from y and y' as they stand.
  bool restart(double t) {
    h_ = options_.initial_step > 0 ? options_.initial_step : first_step_fraction * scale_;
    h_ = std::min(h_, longest());
    order_ = degree_ = 1;
    steps_since_change_ = 0;
    first_ = rising_ = true;
    renew_ = true;
    step_->begin(t, y_.data(), ydot_.data());
    return true;
  }

  bool step(double& t, double end, std::string& cause) {
    failures_ = 0;
    while (true) {
      const double t1 = t + 1.0001 * h_ >= end ? end : t + h_;
      if (t1 < end && h_ < 4 * epsilon * std::max(std::abs(t), 1e-9 * scale_)) {
        cause =
            "the step became as short as the rounding of t" + (cause_.empty() ? "" : ": " + cause_);
        return false;
      }
      h_ = t1 - t;
      if (!attempt(t1)) {
        ++counters_.rejected;
        if (failures_ < most_failures) continue;
        cause = cause_ + " with the shortest step";
        return false;
      }
      ++counters_.steps;
      choose();
      share_.passed(h_);
      step_->accept();
      first_ = false;
      std::copy(step_->y().begin(), step_->y().end(), y_.begin());
      std::copy(step_->ydot().begin(), step_->ydot().end(), ydot_.begin());
      t = t1;
      return true;
    }
  }

  bool at(double t, double* y, double* ydot) {
    const PastValues& past = step_->past();
    if (t == past.time(0)) {
      std::copy(y_.begin(), y_.end(), y);
      if (ydot != nullptr) std::copy(ydot_.begin(), ydot_.end(), ydot);
      return true;
    }
    past.interpolate(t, std::min(degree_, past.count() - 1), y, ydot);
    return true;
  }

 private:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  static constexpr double first_step_fraction = 1e-4;  ///< part of the span, as with IDA
  static constexpr double worth = 1.5, most_growth = 2;
  static constexpr int most_failures = 15;  ///< in one step

  double longest() const { return options_.max_step > 0 ? options_.max_step : span_; }

  /// One trial; false: sets h_, the order and what to make anew.
  bool attempt(double t1) {
    const BdfStep::Outcome outcome =
        step_->attempt(t1, order_, renew_, {share_.now(), first_ || failures_ > 0 ? 2 : 1});
    const bool fresh = step_->derivatives_are_new();
    renew_ = false;
    switch (outcome) {
      case BdfStep::Outcome::solved:
        return step_->error() <= 1 || reject();
      case BdfStep::Outcome::not_converged:
        cause_ = "Newton's method did not converge";
        break;
      case BdfStep::Outcome::singular:
        cause_ = "the Newton matrix is singular";
        break;
      case BdfStep::Outcome::not_evaluated:
        cause_ = evaluation_cause(system_.failure());
        break;
      case BdfStep::Outcome::not_finite:
        cause_ = "a value that is not a finite number came up";
        break;
    }
    renew_ = true;
    if (!fresh) return false;  // the same step again, with a matrix of its own
    ++failures_;
    change_step(0.25);
    rising_ = false;
    return false;
  }

  bool reject() {
    cause_ = "the local error stayed above its tolerance";
    rising_ = false;
    ++failures_;
    if (failures_ >= 3) {
      order_ = 1;
      change_step(0.25);
      return false;
    }
    const int order = lower_or_same();
    const double estimate = step_->term(order) / (order + 1);
    order_ = order;
    change_step(failures_ == 1 ? std::clamp(0.9 * ratio(estimate, order), 0.25, 0.9) : 0.25);
    return false;
  }

  int lower_or_same() {
    const int k = order_;
    if (k == 1) return 1;
    const double here = step_->term(k), lower = step_->term(k - 1);
    if (k == 2) return lower <= 0.5 * here ? 1 : 2;
    return std::max(lower, step_->term(k - 2)) <= here ? k - 1 : k;
  }

  static double ratio(double estimate, int order) {
    return std::pow(2 * estimate + 1e-4, -1.0 / (order + 1));
  }

  void change_step(double factor) {
    h_ = std::min(h_ * factor, longest());
    steps_since_change_ = 0;
  }

  /// Chooses order and step before an accepted step joins the past.
  void choose() {
    const int k = order_;
    degree_ = k;
    ++steps_since_change_;
    int next = lower_or_same();
    if (rising_) {
      if (next < k || k == highest_) rising_ = false;
    }
    if (rising_) {
      order_ = k + 1;
      change_step(2);
      return;
    }
    // The order above needs one more value than this step's.
    const bool can_rise =
        next == k && k < highest_ && steps_since_change_ > k + 1 && step_->past().count() > k + 1;
    if (can_rise) {
      const double here = step_->term(k), above = step_->term(k + 1);
      if (k == 1) {
        if (above < 0.5 * here) next = 2;
      } else if (above < here) {
        next = step_->term(k - 1) <= std::min(here, above) ? k - 1 : k + 1;
      }
    }
    if (next != k) steps_since_change_ = 0;
    order_ = next;
    const double factor = ratio(step_->term(next) / (next + 1), next);
    if (factor >= worth) change_step(std::min(factor, most_growth));
    if (factor < 1) change_step(std::clamp(factor, 0.5, 0.9));
  }

  DaeSystem& system_;
  const IntegrationOptions& options_;
  std::unique_ptr<BdfStep> step_;
  std::vector<double> y_, ydot_;
  double span_, scale_, h_ = 0;  ///< [s]; steps at a start are parts of the scale
  LocalShare share_;
  int highest_ = BdfStep::highest_order, order_ = 1;
  int degree_ = 1;  ///< degree of dense output
  int steps_since_change_ = 0, failures_ = 0;
  bool first_ = true;  ///< no step since the start
  bool rising_ = true, renew_ = true;
  std::string cause_;
  Counters counters_;
};

}  // namespace

IntegrationResult integrate_bdf5(DaeSystem& system, double t0,
                                 const std::vector<double>& output_times,
                                 const IntegrationOptions& options, const Observer& observer) {
  expect_tolerances(options, "bdf5");
  const OutputCursor outputs(t0, output_times);
  Bdf5 method(system, options, outputs.end() - t0);
  const bool started = method.start(t0);
  return run_from_start(method, started, system.failure(), system, t0, output_times, options,
                        observer);
}

Integrator bdf5_integrator() {
  return {.name = "bdf5",
          .takes = Integrator::Takes::dae,
          .step = Integrator::Step::adaptive,
          .multistep = true,
          .method = "BDF of orders 1 to 5 on past values, whose gauge moves",
          .resets = true,
          .gauge = Integrator::Preferred::reset,
          .dae_run = integrate_bdf5};
}

}  // namespace momenta
