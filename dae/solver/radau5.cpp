// F(t, y, y') = 0 by Radau IIA, order 5, stiffly accurate: y_new satisfies F to the Newton
// tolerance, algebraic equations with it. Index up to 3.
//
// Local error: the embedded formula of order 3 with γ_0 = 1/γ and the old rate,
//   d = γ_0 h y'_n + e_1 Z_1 + e_2 Z_2 + e_3 Z_3,  err = J(γ/h)⁻¹ (γ/h) ∂F/∂y' d,
// filtered once more where it fails at the start or after a rejection. For M y' = f this is
// RADAU5's estimate; ∂F/∂y' has no columns for multipliers, whatever their rate in d. Norms weigh a
// variable of index 2 by h (DaeSystem::weight); multipliers are in neither norm.
// Tolerances: error and estimate are of orders 5 and 3, so the estimate is held at 0.1 tol^(2/3).
// Step: options.step, without error control, where given; else Gustafsson's prediction; kept, with
// its factors, where it would grow by less than a fifth. In long runs each step has a share of the
// tolerance (local_share.h), the estimate its power 2/3. Gauge reset (gauge_symmetry.h): σ leaves p
// before each step, and by the same constant what the last step foresees of the next; any two
// stages differ in the new gauge as in the old but by (Φ_q(q_i) − Φ_q(q_0))ᵀσ. Newton's corrections
// that shrink no more are rounding where they leave the motion as it is. Dense output: the
// collocation cubic between steps; a sample is a step of its own from the last step's start, of
// full order and on all constraints; where its iteration does not converge, the cubic. Looking on
// counts nothing and changes nothing.
//
// Order on y, on variables of index 2, of index 3: 5, 3 in index-2 systems; 4, 3, 2 in those of
// index 3. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8, VII.4, VII.6;
// Hairer, Lubich, Roche, The Numerical Solution of Differential-Algebraic Systems by RK Methods.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/solver/fixed_grid.h>
#include <momenta/dae/solver/gauge_symmetry.h>
#include <momenta/dae/solver/implicit_methods.h>
#include <momenta/dae/solver/local_share.h>
#include <momenta/dae/solver/ode_restart.h>
#include <momenta/dae/solver/radau5_stages.h>

#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

using namespace radau5;
using StageValues = std::array<std::vector<double>, 3>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double first_step_fraction = 1e-4;  ///< of the span, as with IDA
constexpr double safety = 0.9, shrink = 0.125, grow = 8;
constexpr double moving_part = 1.0 / 3;
constexpr int most_iterations = 7;
constexpr int patient_iterations = 40;  ///< no shorter step can be tried
/// Newton contracts this fast: the derivatives serve another step.
constexpr double fast = 1e-3;
constexpr std::array<double, 3> error_weights{gamma0 * (-13 - 7 * root6) / 3,
                                              gamma0*(-13 + 7 * root6) / 3, gamma0 * -1.0 / 3};

class Radau5 {
 public:
  Radau5(DaeSystem& system, const IntegrationOptions& options, double span)
      : system_(system),
        gauge_(dynamic_cast<GaugeSymmetry*>(&system)),
        options_(options),
        span_(span),
        share_(span, options.rtol),
        inner_(0.1 * std::pow(options.rtol, 2.0 / 3)),
        norm_(system, inner_, inner_ * options.atol / options.rtol),
        n_(static_cast<std::size_t>(system.size())) {
    for (auto* v : {&y_, &ydot_, &y0_, &ydot0_, &error_}) v->resize(n_);
    for (auto* z : {&z_, &trial_, &sample_})
      for (auto& v : *z) v.resize(n_);
    if (gauge_ == nullptr || gauge_->impulse_count() == 0) gauge_ = nullptr;
    if (gauge_ == nullptr) return;
    directions_.resize(static_cast<std::size_t>(gauge_->direction_entries()));
    constant_.resize(static_cast<std::size_t>(gauge_->impulse_count()));
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
    factors_ = std::make_unique<Factors>(system_.size(), system_.pattern());
    if (options_.step > 0) {
      h_ = options_.step;
      return;
    }
    h_ = options_.initial_step > 0 ? options_.initial_step : first_step_fraction * span_;
    h_ = std::min(h_, longest());
  }

  /// From y and y' as they stand; the step is what it was before.
  bool restart(double) {
    first_ = changed_ = true;
    have_derivatives_ = false;
    return true;
  }

  bool step(double& t, double end, std::string& cause) {
    if (gauge_ != nullptr && gauge_->resets()) reset(t);
    y0_ = y_;
    ydot0_ = ydot_;
    t_ = t;
    norm_set_for_ = 0;
    while (true) {
      const double t1 = step_end(t, end);
      if (options_.step > 0 && rejected_ && have_derivatives_)
        return cause = failure_ + ", with a step of " + in_words(options_.step) + " s", false;
      // The floor of the step is met by rounding alone, not where the run ends.
      if (h_ <= 16 * epsilon * std::max(std::abs(t), 1e-6 * span_) && t1 < end)
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
    for (std::size_t k = 0; k < n_; ++k) y[k] = y0_[k] + polynomial(k, (t - t0_) / done_);
    return true;
  }

  bool sample(double t, double* y, double* ydot) {
    if (t >= t1_ - 4 * epsilon * std::abs(t1_)) {
      std::copy(y_.begin(), y_.end(), y);
      std::copy(ydot_.begin(), ydot_.end(), ydot);
    } else if (!step_to(t, y, ydot)) {
      at(t, y, nullptr);
      for (std::size_t k = 0; k < n_; ++k) ydot[k] = slope(k, (t - t0_) / done_) / done_;
    }
    return true;
  }

  Counters counters() const {
    Counters c = counters_;
    if (stages_) {
      c.evaluations = stages_->evaluations;
      c.newton_iterations = stages_->iterations;
    }
    return c;
  }

 private:
  /// Whether the corrections that do not shrink any more are rounding: of the motion they change
  /// no more than a tenth of its tolerance (as bdf_step.h has it). What is left of them is along
  /// Φ_qᵀ, as large as the rounding of q makes it.
  bool rounding_is_left() {
    if (gauge_ == nullptr) return false;
    const double share = 0.1 * share_.now();
    gauge_->measure_at(t_, y0_.data(), ydot0_.data(), share * options_.rtol, share * options_.atol);
    stages_->last_correction(error_.data());
    return gauge_->motion_squares(error_.data()) <= 1;
  }

  /// y, y' and the last step's stages in the gauge in which σ is zero now.
  void reset(double t) {
    const double* sigma = gauge_->impulses(y_.data());
    for (std::size_t i = 0; i < constant_.size(); ++i) constant_[i] = -sigma[i];
    if (!first_) {
      error_ = y0_;
      shift(t0_, y0_);
      for (std::size_t i = 0; i < z_.size(); ++i) {
        for (std::size_t k = 0; k < n_; ++k) z_[i][k] += error_[k];
        shift(t0_ + c[i] * done_, z_[i]);
        for (std::size_t k = 0; k < n_; ++k) z_[i][k] -= y0_[k];
      }
    }
    gauge_->reset(t, y_.data(), ydot_.data());
  }
  void shift(double t, std::vector<double>& y) {
    gauge_->gauge_directions(t, y.data(), directions_.data());
    gauge_->shift(directions_.data(), constant_.data(), y.data());
  }

  /// What Newton's method leaves, over the tolerance of the estimate.
  double fraction() const { return std::max(norm_.rounding(), std::min(0.03, std::sqrt(inner_))); }
  /// Of the tolerance of the estimate.
  double share() const { return std::pow(share_.now(), 2.0 / 3); }

  double longest() const { return options_.max_step > 0 ? options_.max_step : span_; }

  double step_end(double t, double end) {
    if (options_.step > 0) {
      const FixedGrid grid(start_, options_.step);
      const double t1 = grid.next(counters_.steps, end);
      changed_ |= grid.length(t, t1) != h_;
      h_ = grid.length(t, t1);
      return t1;
    }
    double t1 = t + h_;
    if (t + 1.01 * h_ >= end) t1 = end;
    if (t1 != t + h_) changed_ = true;
    if (t1 == end) h_ = end - t;
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

  /// One trial. False: h_ and what is to be done anew are set.
  bool attempt(double t, double t1) {
    if (changed_ || !have_factors_) {
      counters_.factorizations += 2;
      if (!stages_->factor(*factors_, h_)) return fail("the Newton matrix is singular", 0.5);
      have_factors_ = true;
      changed_ = false;
    }
    if (norm_set_for_ != h_) norm_.set(y0_.data(), norm_set_for_ = h_, share());
    guess(trial_, h_, 1);
    const int most = options_.step > 0 ? patient_iterations : most_iterations;
    const Outcome outcome =
        stages_->solve(*factors_, t, h_, y0_.data(), norm_, fraction(), most, trial_);
    switch (outcome) {
      case Outcome::converged:
        break;
      case Outcome::slow:
      case Outcome::diverged:
        if (rounding_is_left()) break;
        return fail("Newton's method did not converge", 0.5);
      case Outcome::evaluation_failed:
        return fail(evaluation_cause(system_.failure()), 0.25);
      case Outcome::not_finite:
        return fail("a value that is not a finite number came up", 0.25);
    }
    const double error = options_.step > 0 ? 0 : local_error();
    if (!std::isfinite(error)) return fail("a value that is not a finite number came up", 0.25);
    // The more iterations it takes, the more careful the next step.
    const double caution = std::min(
        safety, safety * (1 + 2 * most_iterations) / (stages_->count + 2 * most_iterations));
    const double by_error =
        std::clamp(std::pow(std::max(error, 1e-20), 0.25) / caution, 1 / grow, 1 / shrink);
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

  double local_error() {
    for (std::size_t k = 0; k < n_; ++k)
      error_[k] = gamma0 * h_ * ydot0_[k] + error_weights[0] * trial_[0][k] +
                  error_weights[1] * trial_[1][k] + error_weights[2] * trial_[2][k];
    stages_->filter(*factors_, h_, error_.data());
    double error = size_of_error();
    if (error >= 1 && (first_ || rejected_)) {
      stages_->filter(*factors_, h_, error_.data());
      error = size_of_error();
    }
    return error;
  }
  /// With gauge reset, of what moves alone, which is held at a third: about what it is of the whole
  /// where σ is small.
  double size_of_error() {
    if (gauge_ == nullptr || !gauge_->resets()) return norm_.of(error_.data());
    const double rtol = share() * inner_ * moving_part;
    gauge_->measure_at(t_, y0_.data(), ydot0_.data(), rtol, rtol * options_.atol / options_.rtol);
    return std::sqrt(gauge_->motion_squares(error_.data()));
  }

  void accept(double t, double t1, double error, double by_error) {
    ++counters_.steps;
    share_.passed(h_);
    std::swap(z_, trial_);
    t0_ = t, t1_ = t1, done_ = h_;
    for (std::size_t k = 0; k < n_; ++k) y_[k] = y0_[k] + z_[2][k];
    stages_->rate(2, h_, z_, ydot_.data());
    double divisor = by_error;
    if (!first_) {
      const double predicted = old_step_ / h_ * std::pow(error * error / old_error_, 0.25) / safety;
      divisor = std::max(divisor, std::clamp(predicted, 1 / grow, 1 / shrink));
    }
    old_step_ = h_;
    old_error_ = std::max(1e-2, error);
    double factor = 1 / divisor;
    if (rejected_) factor = std::min(factor, 1.0);
    have_derivatives_ = stages_->theta <= fast;
    derivatives_fresh_ = false;
    if (options_.step > 0) {
      first_ = false;
      return;
    }
    if (!(have_derivatives_ && factor >= 1 && factor <= 1.2)) {
      h_ = std::min(h_ * factor, longest());
      changed_ = true;
    }
    first_ = rejected_ = false;
  }

  /// The last step's collocation polynomial less its start, component k, at a fraction of the step:
  /// the cubic through 0 at 0 and Z_i at c_i.
  double polynomial(std::size_t k, double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
      sum += z_[i][k] * (x * (x - c[j]) * (x - c[l])) / (c[i] * (c[i] - c[j]) * (c[i] - c[l]));
    }
    return sum;
  }

  /// Its derivative by that fraction.
  double slope(std::size_t k, double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double b = c[(i + 1) % 3], d = c[(i + 2) % 3];
      sum += z_[i][k] * (3 * x * x - 2 * (b + d) * x + b * d) / (c[i] * (c[i] - b) * (c[i] - d));
    }
    return sum;
  }

  /// Starting values for stages of a step of length h from y0_: that polynomial prolonged past the
  /// last step's end (`past` 1) or inside it (0); before the first step a straight line.
  void guess(StageValues& z, double h, double past) const {
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        z[i][k] = first_ ? c[i] * h * ydot0_[k]
                         : polynomial(k, past + c[i] * h / done_) - past * z_[2][k];
  }

  /// The step from the last one's start to a time inside it; false when it does not converge.
  bool step_to(double t, double* y, double* ydot) {
    const double h = t - t0_;
    if (h <= 4 * epsilon * std::max(std::abs(t0_), 1e-6 * span_)) {
      std::copy(y0_.begin(), y0_.end(), y);
      std::copy(ydot0_.begin(), ydot0_.end(), ydot);
      return true;
    }
    if (!look_) {
      look_ = std::make_unique<Stages>(system_);
      look_factors_ = std::make_unique<Factors>(system_.size(), system_.pattern());
    }
    if (look_derivatives_ != t0_ &&
        !look_->differentiate(t0_, y0_.data(), ydot0_.data(), gamma / done_))
      return false;
    look_derivatives_ = t0_;
    norm_.set(y0_.data(), h, share());
    norm_set_for_ = 0;
    guess(sample_, h, 0);
    look_->contraction = 1;
    const bool solved = look_->factor(*look_factors_, h) &&
                        look_->solve(*look_factors_, t0_, h, y0_.data(), norm_, fraction(),
                                     patient_iterations, sample_) == Outcome::converged;
    for (std::size_t k = 0; k < n_; ++k) y[k] = y0_[k] + sample_[2][k];
    look_->rate(2, h, sample_, ydot);
    return solved;
  }

  DaeSystem& system_;
  GaugeSymmetry* gauge_;  ///< null: there is none
  const IntegrationOptions& options_;
  double span_;
  LocalShare share_;
  double inner_;  ///< tolerance of the estimate
  WeightedNorm norm_;
  std::size_t n_;
  std::unique_ptr<Stages> stages_, look_;  ///< of the run, and of samples
  std::unique_ptr<Factors> factors_, look_factors_;
  double look_derivatives_ = std::numeric_limits<double>::quiet_NaN();  ///< taken at this t [s]
  std::vector<double> y_, ydot_, y0_, ydot0_, error_;  ///< at the step's end and start
  StageValues z_, trial_, sample_;
  std::vector<double> directions_, constant_;  ///< of a change of gauge
  double start_ = 0;                           ///< of the run [s]
  double t_ = 0;                               ///< where the step under way begins [s]
  double t0_ = 0, t1_ = 0, done_ = 0;          ///< the last step [s]
  double h_ = 0;                               ///< tried next [s]
  double old_step_ = 0, old_error_ = 1, norm_set_for_ = 0;
  bool first_ = true, rejected_ = false;
  bool changed_ = true;  ///< h_ is not that of the factors
  bool have_derivatives_ = false, derivatives_fresh_ = false, have_factors_ = false;
  std::string failure_;
  Counters counters_;
};

}  // namespace

IntegrationResult integrate_radau5(DaeSystem& system, double t0,
                                   const std::vector<double>& output_times,
                                   const IntegrationOptions& options, const Observer& observer) {
  if (!(options.rtol > 0) || !(options.atol > 0))
    throw std::invalid_argument("rtol and atol of radau5 must be positive");
  const OutputCursor outputs(t0, output_times);
  Radau5 radau(system, options, outputs.end() - t0);
  IntegrationResult result;
  result.jacobian = "dual numbers";
  result.end_time = t0;
  const bool started = radau.start(t0);
  result.linear_solver = radau.linear_solver();
  if (!started) {
    result.reason = stop_sentence("radau5", t0, evaluation_cause(system.failure()));
    result.y.assign(radau.y(), radau.y() + system.size());
    return result;
  }
  if (outputs.end() > t0) radau.initialise();
  run_with_ode_restarts(radau, system, t0, output_times, options, observer, result);
  result.counters += radau.counters();
  return result;
}

}  // namespace momenta
