#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/newmark.h>
#include <momenta/dae/integrator/ode_restart.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

constexpr double newton_fraction = 1e-3;  ///< share of the tolerance
constexpr double fast_enough = 0.3;       ///< contraction with a matrix of an earlier step
constexpr int most_iterations = 20;
constexpr int most_projections = 6;

std::ptrdiff_t offset(std::size_t i) {
  return static_cast<std::ptrdiff_t>(i);
}

}  // namespace

Newmark::Newmark(const char* name, const NewmarkRule& rule, DaeSystem& system, SecondOrder& order,
                 double t0, const IntegrationOptions& options)
    : name_(name),
      rule_(rule),
      system_(system),
      order_(order),
      local_(dynamic_cast<LocalOfSecondOrder*>(system.local())),
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
  correction_.resize(n_);
  delta_.resize(std::max(nv_, n_ - nq_ - nv_));
}

bool Newmark::start() {
  if (!system_.start(t0_, now_.y.data(), now_.ydot.data())) return false;
  std::copy_n(now_.ydot.begin() + offset(nq_), nv_, now_.a.begin());
  old_ = now_;
  if (local_ != nullptr) {
    rate_factors_.resize(n_);
  } else {
    lay_out_matrix();
    for (Factored* f : {&run_matrix_, &look_matrix_}) {
      f->matrix = make_newton_matrix<double>(system_.size(), pattern_);
      std::fill_n(f->matrix->values(), entry_count(system_.size(), pattern_), 0.0);
    }
    by_y_.resize(entry_count(system_.size(), system_.pattern()));
    by_rate_.resize(by_y_.size());
  }
  return all_finite(now_.y.data(), n_) && all_finite(now_.ydot.data(), n_);
}

bool Newmark::step(double& t, double end, std::string& cause) {
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

bool Newmark::at(double t, double* y, double*) {
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

bool Newmark::sample(double t, double* y, double* ydot) {
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

/// Solves a step from old_ at t over h into `next`.
bool Newmark::solve(double t, double h, State& next, Factored& matrix, Counters& counters) {
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
      // The remaining error is about ratio/(1 − ratio) of the correction; one correction is not
      // trusted alone.
      if (size <= norm_.rounding() ||
          (count > 1 && ratio < 0.9 && size * ratio / (1 - ratio) <= newton_fraction)) {
        place(h, next);
        // An earlier step's matrix would do for Newton's method; projections by it would err by its
        // age, and cost an order.
        if (rule_.augmented)
          return differentiate(t, h, next, matrix, counters) &&
                 project(t + h, next, *matrix.matrix);
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

/// Guesses with the accelerations and multipliers of the step's start.
void Newmark::guess(State& next) {
  std::copy_n(old_.ydot.begin(), n_, next.ydot.begin());
  std::copy_n(old_.y.begin(), n_, next.y.begin());
}

/// Sets a, q, v and q̇ at the end from v̇ there.
void Newmark::place(double h, State& next) {
  const double *old_v = old_.y.data() + nq_, *old_vdot = old_.ydot.data() + nq_;
  const double* vdot = next.ydot.data() + nq_;
  double* v = next.y.data() + nq_;
  for (std::size_t i = 0; i < nv_; ++i) {
    next.a[i] =
        ((1 - rule_.f) * vdot[i] + rule_.f * old_vdot[i] - rule_.m * old_.a[i]) / (1 - rule_.m);
    v[i] = old_v[i] + h * ((1 - rule_.gamma) * old_.a[i] + rule_.gamma * next.a[i]);
    delta_[i] = h * (old_v[i] + h * ((0.5 - rule_.beta) * old_.a[i] + rule_.beta * next.a[i]));
  }
  order_.move(old_.y.data(), delta_.data(), next.y.data());
  place_rates(next);
}
void Newmark::place_rates(State& next) {
  order_.coordinate_rates(next.y.data(), next.y.data() + nq_, next.ydot.data());
  std::fill(next.ydot.begin() + offset(nq_ + nv_), next.ydot.end(), 0.0);
}

bool Newmark::evaluation_failed() {
  cause_ = evaluation_cause(system_.failure());
  return false;
}

/// One Newton step on v̇ and λ; correction_ is that of y.
bool Newmark::correct(double t, double h, State& next, NewtonMatrix<double>& matrix,
                      Counters& counters) {
  place(h, next);
  ++counters.evaluations;
  if (!system_.residual(t + h, next.y.data(), next.ydot.data(), residual_.data()))
    return evaluation_failed();
  // Redundant loops need the penalty alone: Φ itself, without ε λ.
  if (rule_.augmented) order_.constraints(t + h, next.y.data(), residual_.data() + nq_ + nv_);
  for (std::size_t row = 0; row < n_; ++row)
    residual_[row] = row < nq_ ? 0 : -row_scale(row, h) * residual_[row];
  solve_with(matrix, residual_.data());
  for (std::size_t i = 0; i < n_; ++i) residual_[i] /= column_scale(i, h);
  const double c_v = 1 / (h * rule_.gamma * rule_.kappa());
  for (std::size_t i = nq_; i < nq_ + nv_; ++i) next.ydot[i] += c_v * residual_[i];
  for (std::size_t i = nq_ + nv_; i < n_; ++i) next.y[i] += residual_[i];
  correction_ = residual_;
  return true;
}

/// Takes v onto Φ̇ = 0, then v̇ onto Φ̈ = 0. A right-hand side b of the scaled matrix in the rows
/// of Φ alone has a solution with Φ_q w = b in w = (β/γ) times its part of v. Repeated to rounding,
/// as the penalty leaves a part in 1/penalty.
bool Newmark::project(double t, State& next, NewtonMatrix<double>& matrix) {
  const double *q = next.y.data(), factor = rule_.beta / rule_.gamma;
  double *v = next.y.data() + nq_, *vdot = next.ydot.data() + nq_;
  for (double* corrected : {v, vdot}) {
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_projections; ++k) {
      if (corrected == v)
        order_.constraint_rates(t, q, v, delta_.data());
      else
        order_.constraint_accelerations(t, q, v, vdot, delta_.data());
      std::fill_n(residual_.begin(), nq_ + nv_, 0.0);
      for (std::size_t i = nq_ + nv_; i < n_; ++i) residual_[i] = -delta_[i - nq_ - nv_];
      solve_with(matrix, residual_.data());
      double size = 0, largest = 0;
      for (std::size_t i = 0; i < nv_; ++i) {
        size = std::max(size, std::abs(factor * residual_[nq_ + i]));
        largest = std::max(largest, std::abs(corrected[i]));
      }
      if (!std::isfinite(size)) {
        cause_ = "the projection of rates is not finite";
        return false;
      }
      if (!(size < 0.5 * before)) break;
      for (std::size_t i = 0; i < nv_; ++i) corrected[i] += factor * residual_[nq_ + i];
      if (size <= 4 * std::numeric_limits<double>::epsilon() * largest) break;
      before = size;
    }
  }
  std::copy_n(vdot, nv_, next.a.begin());
  place_rates(next);
  return true;
}

IntegrationResult integrate_newmark(const char* name, const NewmarkRule& rule, DaeSystem& system,
                                    double t0, const std::vector<double>& output_times,
                                    const IntegrationOptions& options, const Observer& observer) {
  auto* order = dynamic_cast<SecondOrder*>(&system);
  const std::string method(name);
  if (order == nullptr)
    throw std::invalid_argument(
        method + " takes equations of second order: expected form acceleration-index3");
  expect_fixed_step(options, method);
  expect_tolerances(options, method);
  const OutputCursor outputs(t0, output_times);
  Newmark run(name, rule, system, *order, t0, options);
  const bool started = run.start();
  return run_from_start(run, started, system.failure(), system, t0, output_times, options,
                        observer);
}

}  // namespace momenta
