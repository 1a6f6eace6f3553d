// The generalised-α method on equations of index 3, fixed steps, order 2:
//
//   q_{n+1} = q_n ∘ exp(h v_n + h² ((½ − β) a_n + β a_{n+1})),  v_{n+1} = v_n + h ((1 − γ) a_n + γ
//   a_{n+1}), (1 − α_m) a_{n+1} + α_m a_n = (1 − α_f) v̇_{n+1} + α_f v̇_n, M v̇ + Φ_qᵀλ = Q and Φ = 0
//   at n + 1; α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1), γ = ½ + α_f − α_m, β = (γ + ½)²/4,
//
// ρ in [0, 1) the spectral radius at infinite frequency. a is no acceleration of the solution at
// t_n but near t_n + (α_m − α_f) h; it starts as v̇(0), so that λ has an error of order 1 in its
// first steps, damped like ρ^n.
//
// Newton's unknowns are v̇ and λ. With κ = (1 − α_f)/(1 − α_m), δv = hγκ δv̇ and δq = E h²βκ δv̇ the
// matrix is that of the system, ∂F/∂y + ∂F/∂y' diag(c), c = γ/(βh) in the columns of q and 1/(hγκ)
// in those of v. Its kinematic rows are kept and met exactly. Rows of (1a) times h², kinematic rows
// times h, unknowns (δq, h δv, h² δλ): its condition does not grow as h shrinks.
// Φ holds to the Newton tolerance, 10⁻³ of the run's; Φ̇ to order 2.
// Source: Chung, Hulbert, J. Appl. Mech. 60 (1993) 371-375; Arnold, Brüls, Multibody System
// Dynamics 18 (2007) 185-202; scaling: Bottasso, Bauchau, Cardona, SIAM J. Sci. Comput. 29 (2007)
// 397-414.

#include <momenta/dae/solver/fixed_grid.h>
#include <momenta/dae/solver/implicit_methods.h>
#include <momenta/dae/solver/multistep_run.h>
#include <momenta/dae/solver/newton_matrix.h>
#include <momenta/dae/solver/second_order.h>
#include <momenta/dae/solver/sundials_handles.h>
#include <momenta/dae/solver/weighted_norm.h>

#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

constexpr double newton_fraction = 1e-3;  ///< of the tolerance
constexpr double fast_enough = 0.3;       ///< contraction with a matrix of an earlier step
constexpr int most_iterations = 20;

/// Coefficients by ρ.
struct Alpha {
  explicit Alpha(double rho)
      : m((2 * rho - 1) / (rho + 1)),
        f(rho / (rho + 1)),
        gamma(0.5 + f - m),
        beta(0.25 * (gamma + 0.5) * (gamma + 0.5)),
        kappa((1 - f) / (1 - m)) {}
  double m, f, gamma, beta, kappa;
};

/// The Newton matrix and the step it was made for; 0: none yet.
struct Factored {
  std::unique_ptr<NewtonMatrix<double>> matrix;
  double step = 0;
};

/// q, v, v̇, λ, a at one time.
struct State {
  std::vector<double> y, ydot, a;
};

class GeneralisedAlpha {
 public:
  GeneralisedAlpha(DaeSystem& system, SecondOrder& order, double rho, double t0,
                   const IntegrationOptions& options)
      : system_(system),
        order_(order),
        alpha_(rho),
        grid_(t0, options.step),
        norm_(system, options.rtol, options.atol),
        nq_(static_cast<std::size_t>(order.coordinates())),
        nv_(static_cast<std::size_t>(order.rates())),
        n_(static_cast<std::size_t>(system.size())),
        t0_(t0),
        t1_(t0) {
    for (State* s : {&old_, &now_, &look_}) {
      s->y.resize(n_);
      s->ydot.resize(n_);
      s->a.resize(nv_);
    }
    residual_.resize(n_);
    delta_.resize(nv_);
  }

  static const char* name() { return "generalised-alpha"; }
  const char* linear_solver() const { return linear_solver_name(system_.pattern()); }
  double* y() { return now_.y.data(); }
  double* ydot() { return now_.ydot.data(); }

  bool start() {
    if (!system_.start(t0_, now_.y.data(), now_.ydot.data())) return false;
    std::copy_n(now_.ydot.begin() + offset(nq_), nv_, now_.a.begin());
    for (Factored* f : {&run_matrix_, &look_matrix_})
      f->matrix = make_newton_matrix<double>(system_.size(), system_.pattern());
    by_y_.resize(entry_count(system_.size(), system_.pattern()));
    old_ = now_;
    return sundials::all_finite(now_.y.data(), static_cast<long>(n_)) &&
           sundials::all_finite(now_.ydot.data(), static_cast<long>(n_));
  }

  bool step(double& t, double end, std::string& cause) {
    const double t1 = grid_.next(counters_.steps, end), h = grid_.length(t, t1);
    std::swap(old_, now_);
    if (!solve(t, h, now_, run_matrix_, counters_)) {
      std::swap(old_, now_);
      ++counters_.rejected;
      cause = cause_ + ", with a step of " + in_words(h) + " s";
      return false;
    }
    ++counters_.steps;
    t0_ = t, t1_ = t1;
    t = t1;
    return true;
  }

  /// Hermite's cubic for q and v; λ along a line.
  bool at(double t, double* y, double*) {
    const double h = t1_ - t0_, x = (t - t0_) / h;
    for (std::size_t i = 0; i < n_; ++i) {
      const double from = old_.y[i], to = now_.y[i];
      y[i] = from + x * (to - from);
      if (i < nq_ + nv_)
        y[i] += x * (x - 1) *
                ((1 - 2 * x) * (to - from) + h * ((x - 1) * old_.ydot[i] + x * now_.ydot[i]));
    }
    return true;
  }

  /// The step from the last one's start to an output time; the cubic where that does not converge.
  bool sample(double t, double* y, double* ydot) {
    const State* found = &look_;
    if (std::abs(t - t1_) <= grid_.tolerance())
      found = &now_;
    else if (std::abs(t - t0_) <= grid_.tolerance())
      found = &old_;
    else {
      Counters uncounted;
      look_matrix_.step = 0;
      const bool solved = solve(t0_, t - t0_, look_, look_matrix_, uncounted);
      if (!solved) {
        at(t, look_.y.data(), nullptr);
        const double x = (t - t0_) / (t1_ - t0_);
        for (std::size_t i = 0; i < n_; ++i)
          look_.ydot[i] = old_.ydot[i] + x * (now_.ydot[i] - old_.ydot[i]);
      }
    }
    std::copy(found->y.begin(), found->y.end(), y);
    std::copy(found->ydot.begin(), found->ydot.end(), ydot);
    return true;
  }

  const Counters& counters() const { return counters_; }

 private:
  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  /// From old_ at t over h into `next`.
  bool solve(double t, double h, State& next, Factored& matrix, Counters& counters) {
    norm_.set(old_.y.data(), h);
    bool fresh = false;
    while (true) {
      guess(next);
      if (matrix.step != h) {
        if (!differentiate(t, h, next, matrix, counters)) return false;
        fresh = true;
      }
      double last = 0;
      for (int count = 1; count <= most_iterations; ++count) {
        ++counters.newton_iterations;
        if (!correct(t, h, next, *matrix.matrix, counters)) return false;
        const double size = norm_.of(correction_.data());
        if (!std::isfinite(size)) break;
        const double ratio = count > 1 ? size / last : 0;
        last = size;
        // The remaining error is about ratio/(1 − ratio) of the correction; one is not trusted
        // alone.
        if (size <= norm_.rounding() ||
            (count > 1 && ratio < 0.9 && size * ratio / (1 - ratio) <= newton_fraction)) {
          place(h, next);
          if (ratio > fast_enough) matrix.step = 0;
          return true;
        }
        if (count > 3 && ratio > (fresh ? 0.9 : fast_enough)) break;
      }
      matrix.step = 0;
      if (fresh) {
        cause_ = "Newton's method did not converge";
        return false;
      }
    }
  }

  /// The accelerations and multipliers of the step's start.
  void guess(State& next) {
    std::copy_n(old_.ydot.begin(), n_, next.ydot.begin());
    std::copy_n(old_.y.begin(), n_, next.y.begin());
  }

  /// a, q, v and q̇ at the end from v̇ there.
  void place(double h, State& next) {
    const double *old_v = old_.y.data() + nq_, *old_vdot = old_.ydot.data() + nq_;
    const double* vdot = next.ydot.data() + nq_;
    double* v = next.y.data() + nq_;
    for (std::size_t i = 0; i < nv_; ++i) {
      next.a[i] = ((1 - alpha_.f) * vdot[i] + alpha_.f * old_vdot[i] - alpha_.m * old_.a[i]) /
                  (1 - alpha_.m);
      v[i] = old_v[i] + h * ((1 - alpha_.gamma) * old_.a[i] + alpha_.gamma * next.a[i]);
      delta_[i] = h * (old_v[i] + h * ((0.5 - alpha_.beta) * old_.a[i] + alpha_.beta * next.a[i]));
    }
    order_.move(old_.y.data(), delta_.data(), next.y.data());
    order_.coordinate_rates(next.y.data(), v, next.ydot.data());
    std::fill(next.ydot.begin() + offset(nq_ + nv_), next.ydot.end(), 0.0);
  }

  bool evaluation_failed() {
    cause_ = evaluation_cause(system_.failure());
    return false;
  }

  /// The scaled matrix at the present guess.
  bool differentiate(double t, double h, State& next, Factored& matrix, Counters& counters) {
    place(h, next);
    ++counters.jacobians;
    ++counters.factorizations;
    const double c_q = alpha_.gamma / (alpha_.beta * h),
                 c_v = 1 / (h * alpha_.gamma * alpha_.kappa);
    double* values = matrix.matrix->values();
    if (!system_.jacobian(t + h, next.y.data(), next.ydot.data(), 0, by_y_.data()) ||
        !system_.jacobian(t + h, next.y.data(), next.ydot.data(), c_v, values))
      return evaluation_failed();
    const JacobianPattern& pattern = system_.pattern();
    for (std::size_t column = 0, k = 0; column < n_; ++column) {
      // values = J_0 + c_v J_1 now.
      const double c = column < nq_ ? c_q / c_v : 1;
      const std::size_t end = pattern.column_start.empty()
                                  ? (column + 1) * n_
                                  : static_cast<std::size_t>(pattern.column_start[column + 1]);
      for (; k < end; ++k) {
        const std::size_t row = pattern.column_start.empty()
                                    ? k - column * n_
                                    : static_cast<std::size_t>(pattern.row[k]);
        values[k] =
            row_scale(row, h) * (by_y_[k] + c * (values[k] - by_y_[k])) / column_scale(column, h);
      }
    }
    matrix.step = matrix.matrix->factor() ? h : 0;
    if (matrix.step == 0) cause_ = "the Newton matrix is singular";
    return matrix.step != 0;
  }
  double row_scale(std::size_t row, double h) const {
    return row < nq_ ? h : (row < nq_ + nv_ ? h * h : 1);
  }
  double column_scale(std::size_t column, double h) const {
    return column < nq_ ? 1 : (column < nq_ + nv_ ? h : h * h);
  }

  /// One Newton step on v̇ and λ; correction_ is that of y.
  bool correct(double t, double h, State& next, NewtonMatrix<double>& matrix, Counters& counters) {
    place(h, next);
    ++counters.evaluations;
    if (!system_.residual(t + h, next.y.data(), next.ydot.data(), residual_.data()))
      return evaluation_failed();
    for (std::size_t row = 0; row < n_; ++row)
      residual_[row] = row < nq_ ? 0 : -row_scale(row, h) * residual_[row];
    matrix.solve(residual_.data());
    for (std::size_t i = 0; i < n_; ++i) residual_[i] /= column_scale(i, h);
    const double c_v = 1 / (h * alpha_.gamma * alpha_.kappa);
    for (std::size_t i = nq_; i < nq_ + nv_; ++i) next.ydot[i] += c_v * residual_[i];
    for (std::size_t i = nq_ + nv_; i < n_; ++i) next.y[i] += residual_[i];
    correction_ = residual_;
    return true;
  }

  DaeSystem& system_;
  SecondOrder& order_;
  Alpha alpha_;
  FixedGrid grid_;
  WeightedNorm norm_;
  std::size_t nq_, nv_, n_;
  State old_, now_, look_;
  std::vector<double> residual_, correction_, delta_, by_y_;
  Factored run_matrix_, look_matrix_;
  double t0_, t1_;  ///< the last step [s]
  std::string cause_;
  Counters counters_;
};

}  // namespace

IntegrationResult integrate_generalised_alpha(DaeSystem& system, double t0,
                                              const std::vector<double>& output_times,
                                              const IntegrationOptions& options,
                                              const Observer& observer) {
  auto* order = dynamic_cast<SecondOrder*>(&system);
  if (order == nullptr)
    throw std::invalid_argument(
        "generalised-alpha takes equations of second order: expected form acceleration-index3");
  if (!(options.step > 0) || !std::isfinite(options.step))
    throw std::invalid_argument("generalised-alpha has fixed steps and needs a step > 0");
  if (!(options.rtol > 0) || !(options.atol > 0))
    throw std::invalid_argument("rtol and atol of generalised-alpha must be positive");
  const double rho = options.spectral_radius;
  if (!(rho >= 0 && rho < 1))
    throw std::invalid_argument("the spectral radius of generalised-alpha must be in [0, 1)");
  const OutputCursor outputs(t0, output_times);
  GeneralisedAlpha method(system, *order, rho, t0, options);
  IntegrationResult result;
  result.jacobian = "dual numbers";
  result.end_time = t0;
  const bool started = method.start();
  result.linear_solver = method.linear_solver();
  if (!started) {
    result.reason = stop_sentence(method.name(), t0, evaluation_cause(system.failure()));
    result.y.assign(method.y(), method.y() + system.size());
    return result;
  }
  MultistepRun<GeneralisedAlpha>(method, system.size(), t0, output_times, options, observer)
      .run(result);
  result.counters = method.counters();
  return result;
}

}  // namespace momenta
