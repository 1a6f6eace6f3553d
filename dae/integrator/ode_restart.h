#pragma once
// An implicit method on a DAE, taken past singular poses.
//
// On a step of length h over a pose where loop equations lose rank, row w of Φ_q vanishing like
// x(t), an implicit method solves for σ_w (or λ_w) with the factor x(t + h) − γ h ẋ, γ h what the
// step weighs its own end with. That is zero for a pose inside the step, whatever the distance of
// its ends: the multiplier is noise there, the error test sees it in p or v, and the shorter step
// lands nearer to the pose. So the way past the pose, from where the weakest pivot of the loops has
// fallen below a hundredth of its best, is made by the same motion as an ODE, by `dop853` at the
// same tolerance, with singularity handling (system.h); behind it the method starts anew with a
// consistent state, a multistep method at order 1. Steps on the way are counted apart.
//
// The way is made in one go; then its steps are told to the run one by one.

#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/multistep_run.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace momenta {

/// `Method` is one of MultistepRun, which provides besides
///   bool restart(double t);   from y() and ydot(), which have been altered.
template <class Method>
class WithOdeRestarts {
 public:
  WithOdeRestarts(Method& method, DaeSystem& system, const IntegrationOptions& options)
      : method_(method),
        system_(system),
        state_(static_cast<std::size_t>(system.ode_restart_size())),
        look_(state_.size()),
        n_(static_cast<std::size_t>(system.size())),
        on_a_grid_(options.step > 0) {
    options_.rtol = options.rtol;
    options_.atol = options.atol;
    options_.max_step = options.max_step;
    options_.max_steps = most_steps;
  }

  const char* name() { return method_.name(); }
  double* y() { return under_way_ ? way_[next_].y.data() : method_.y(); }
  double* ydot() { return under_way_ ? way_[next_].ydot.data() : method_.ydot(); }
  void count(Counters& counters) const {
    counters.steps += steps_;
    counters.ode_restarts += steps_;
    counters.evaluations += evaluations_;
  }

  bool step(double& t, double end, std::string& cause) {
    if (under_way_) {
      if (next_ + 1 < way_.size()) return follow(t);
      under_way_ = false;
      std::copy(way_.back().y.begin(), way_.back().y.end(), method_.y());
      std::copy(way_.back().ydot.begin(), way_.back().ydot.end(), method_.ydot());
      if (!method_.restart(t)) {
        cause = "no start behind a singular pose";
        return false;
      }
    }
    if (t >= not_before_ && plan(t, end)) return follow(t);
    return method_.step(t, end, cause);
  }

  bool at(double t, double* y, double* ydot) {
    if (!under_way_) return method_.at(t, y, ydot);
    return between(t, y, ydot);
  }
  bool sample(double t, double* y, double* ydot) {
    if (under_way_) return between(t, y, ydot);
    if constexpr (requires { method_.sample(t, y, ydot); })
      return method_.sample(t, y, ydot);
    else
      return method_.at(t, y, ydot);
  }

 private:
  /// Longest way past a pose.
  static constexpr long most_steps = 2000;

  struct Place {
    double t;
    std::vector<double> y, ydot;
  };

  bool follow(double& t) {
    ++steps_;
    t = way_[++next_].t;
    return true;
  }

  /// Plans the way from t to where no pivot is weak, or to the end. False where there is none: no
  /// pivot is weak at t, or the way fails, or is too long for a pose to be passed.
  bool plan(double t, double end) {
    if (on_a_grid_ || !system_.near_singular(t, method_.y())) return false;
    OdeSystem& ode = *system_.ode_restart(t, method_.y(), state_.data());
    way_.clear();
    next_ = 0;
    way_.push_back({t, {method_.y(), method_.y() + n_}, {method_.ydot(), method_.ydot() + n_}});
    // A form that drifts is off the constraints, where no two motions meet: closes the loops first.
    bool changed = false, behind = false;
    bool good = ode.after_step(t, state_.data(), changed);
    Observer observer;
    observer.step = [&](double t0, double t1, const Interpolant& at) {
      at(t0, look_.data());  // as corrected after the step before
      if (t0 > t) good = good && add(t0, look_.data());
      at(t1, look_.data());
      behind = !system_.near_singular(t1, look_.data());
      return good && !behind;
    };
    IntegrationResult run = integrate_explicit("dop853", ode, t, state_, {end}, options_, observer);
    evaluations_ += run.counters.evaluations;
    under_way_ = good &&
                 (run.done || (behind && ode.after_step(run.end_time, run.y.data(), changed))) &&
                 add(run.end_time, run.y.data());
    if (!under_way_) not_before_ = run.end_time + 0.01 * (end - t);
    return under_way_;
  }

  bool add(double t, const double* state) {
    Place place{t, way_.back().y, way_.back().ydot};
    const bool good = system_.rejoin(t, state, place.y.data(), place.ydot.data());
    if (good) way_.push_back(std::move(place));
    return good;
  }

  /// Steps from the step's start once more, to a time inside it.
  bool between(double t, double* y, double* ydot) {
    const bool at_end = t == way_[next_].t;
    const Place& from = way_[at_end ? next_ : next_ - 1];
    look_rate_ = from.ydot;
    std::copy(from.y.begin(), from.y.end(), y);
    bool good = true;
    if (t != from.t) {
      IntegrationOptions options = options_;
      options.initial_step = t - from.t;
      OdeSystem& ode = *system_.ode_restart(from.t, from.y.data(), state_.data());
      // Evaluations of this look do not count for the run.
      Memory met;
      ode.carry(met);
      const IntegrationResult run =
          integrate_explicit("dop853", ode, from.t, state_, {t}, options, {});
      Memory back(met.numbers());
      ode.carry(back);
      good = run.done && system_.rejoin(t, run.y.data(), y, look_rate_.data());
    }
    if (ydot) std::copy(look_rate_.begin(), look_rate_.end(), ydot);
    return good;
  }

  Method& method_;
  DaeSystem& system_;
  IntegrationOptions options_;
  std::vector<double> state_, look_, look_rate_;
  std::vector<Place> way_;  ///< its start, then the ends of its steps
  std::size_t next_ = 0, n_;
  bool on_a_grid_;  ///< fixed steps: no ODE restarts
  bool under_way_ = false;
  double not_before_ = -std::numeric_limits<double>::infinity();  ///< after a failed way [s]
  long steps_ = 0, evaluations_ = 0;
};

/// Steps a method whose start() said `started` to the last output time, with ODE restarts where it
/// can restart(); if it did not start, the result says why, in the words of `failure`. An implicit
/// method has linear_solver(), with the exact Jacobian.
template <class Method>
IntegrationResult run_from_start(Method& method, bool started, const std::string& failure,
                                 DaeSystem& system, double t0,
                                 const std::vector<double>& output_times,
                                 const IntegrationOptions& options, const Observer& observer) {
  IntegrationResult result;
  result.end_time = t0;
  if constexpr (requires { method.linear_solver(); }) {
    result.linear_solver = method.linear_solver();
    result.jacobian = "dual numbers";
  }
  if (!started) {
    result.reason = stop_sentence(method.name(), t0, evaluation_cause(failure));
    result.y.assign(method.y(), method.y() + system.size());
    return result;
  }
  if constexpr (requires { method.restart(t0); }) {
    WithOdeRestarts<Method> run(method, system, options);
    MultistepRun<WithOdeRestarts<Method>>(run, system.size(), t0, output_times, options, observer)
        .run(result);
    run.count(result.counters);
  } else {
    MultistepRun<Method>(method, system.size(), t0, output_times, options, observer).run(result);
  }
  result.counters += method.counters();
  return result;
}

}  // namespace momenta
