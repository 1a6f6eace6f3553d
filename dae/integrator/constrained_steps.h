#pragma once
// Methods with fixed steps on a ConstrainedHamiltonian: a start with no σ in p, steps on the grid,
// output inside steps.
//
// `Step`, one step from a state and what it needs to know of the last one, provides
//
//   static const char* name();
//   Step(ConstrainedHamiltonian&);
//   bool start(double t, State&);   to (t, q) of a start; p and u onto Φ_q u + Φ_t = 0
//   bool advance(double t, double h, const State& from, State& to, Counters&);
//                                   false: cause() says why
//   void accept();                  the step just taken is the run's
//   bool repeat(const Step& last, double t, const State& from);
//                                   to the start of the last step that `last` accepted

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/constrained_hamiltonian.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/multistep_run.h>
#include <momenta/dae/integrator/output_cursor.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace momenta::constrained {

struct State {
  Eigen::VectorXd q, p, u;
};

/// Tells when an iteration by substitution has reached rounding.
class Convergence {
 public:
  enum class Is { under_way, reached, failed };
  /// `slack`: how much larger rounding may be than that of the unknowns.
  explicit Convergence(double slack = 1) : rounding_(slack * rounding) {}
  /// To be called after each iteration, with the size of its changes relative to the unknowns'.
  Is after(double size) {
    if (size >= last_ && size <= rounding_) ++stalls_;
    if (size <= reached || stalls_ == patience) return Is::reached;
    if (++count_ == most_iterations) return size <= rounding_ ? Is::reached : Is::failed;
    if (!std::isfinite(size) || size > 1e6 * last_) return Is::failed;
    last_ = size;
    return Is::under_way;
  }

 private:
  static constexpr int most_iterations = 100;
  static constexpr double reached = 4 * std::numeric_limits<double>::epsilon();
  static constexpr double rounding = 1e-13;  ///< below this, changes that do not shrink are noise
  static constexpr int patience = 3;         ///< times that they may not shrink
  double rounding_;
  double last_ = std::numeric_limits<double>::infinity();
  int stalls_ = 0, count_ = 0;
};

/// Iterates to rounding. `once(change)`: one iteration, sets its change relative to the unknowns'
/// size; false: `cause` says why, or a value is not finite. `unsolved`: the cause where changes do
/// not shrink.
template <class Once>
bool to_rounding(Convergence convergence, Counters& counters, std::string& cause,
                 const char* unsolved, Once&& once) {
  cause = "a value that is not a finite number came up";
  for (;;) {
    ++counters.evaluations;
    ++counters.newton_iterations;
    double change = 0;
    if (!once(change)) return false;
    const auto is = convergence.after(change);
    if (is == Convergence::Is::reached) return true;
    if (is == Convergence::Is::under_way) continue;
    if (std::isfinite(change)) cause = unsolved;
    return false;
  }
}

/// Goes to (t, q) of a step's start, with the factors of (7) there.
inline bool go(HamiltonianPlace& place, double t, const State& state) {
  return place.at(t, state.q.data()) && place.factor(t, state.q.data());
}

/// Takes p, and u with it, onto Φ_q u + Φ_t = 0 at `place`, where it was last factorised.
class OntoVelocities {
 public:
  explicit OntoVelocities(const ConstrainedHamiltonian& parts)
      : phi_(parts.multipliers()),
        nu_(parts.multipliers()),
        delta_(parts.momenta()),
        force_(parts.momenta()) {}
  bool operator()(HamiltonianPlace& place, State& state) {
    place.rates(state.p.data(), nullptr, state.u.data());
    if (phi_.size() == 0) return true;
    place.velocities(state.u.data(), phi_.data());
    if (!place.correction(phi_.data(), delta_.data(), nu_.data())) return false;
    place.constraint_forces(nu_.data(), force_.data());
    state.p -= force_;
    place.rates(state.p.data(), nullptr, state.u.data());
    return true;
  }
  /// The same at a step's end, with the matrix of (7) there. False: `cause` says why, if it is the
  /// matrix.
  bool at_end(HamiltonianPlace& place, double t, State& state, Counters& counters,
              std::string& cause) {
    ++counters.factorizations;
    if (!place.factor(t, state.q.data())) {
      cause = "the matrix of (7) could not be factorised";
      return false;
    }
    return (*this)(place, state) && state.p.allFinite() && state.q.allFinite();
  }

 private:
  Eigen::VectorXd phi_, nu_, delta_, force_;
};

/// A method for MultistepRun.
template <class Step>
class Steps {
 public:
  Steps(ConstrainedHamiltonian& parts, double t0, const std::vector<double>& y0, double step)
      : parts_(parts), grid_(t0, step), run_(parts), y_(y0), t0_(t0), t1_(t0) {
    const int nq = parts.coordinates(), nv = parts.momenta();
    now_.q = Eigen::Map<const Eigen::VectorXd>(y0.data(), nq);
    now_.p = Eigen::Map<const Eigen::VectorXd>(y0.data() + nq, nv);
    now_.u = Eigen::VectorXd::Zero(nv);
    old_ = next_ = now_;
    for (Eigen::VectorXd* x : {&from_, &to_, &step_}) *x = now_.q;
  }

  static const char* name() { return Step::name(); }
  double* y() { return y_.data(); }
  double* ydot() { return nullptr; }
  const Counters& counters() const { return counters_; }

  bool start() {
    if (!run_.start(t0_, now_)) return false;
    old_ = now_;
    store(now_, y_.data());
    return all_finite(y_.data(), y_.size());
  }

  bool step(double& t, double end, std::string& cause) {
    const double t1 = grid_.next(counters_.steps, end), h = grid_.length(t, t1);
    if (!run_.advance(t, h, now_, next_, counters_)) {
      ++counters_.rejected;
      cause = run_.cause() + ", with a step of " + in_words(h) + " s";
      return false;
    }
    run_.accept();
    std::swap(old_, now_);
    std::swap(now_, next_);
    store(now_, y_.data());
    ++counters_.steps;
    t0_ = t, t1_ = t1;
    t = t1;
    return true;
  }

  /// Hermite's cubic for q, a line for p.
  bool at(double t, double* y, double*) {
    const double h = t1_ - t0_, x = (t - t0_) / h;
    parts_.coordinate_rates(old_.q.data(), old_.u.data(), from_.data());
    parts_.coordinate_rates(now_.q.data(), now_.u.data(), to_.data());
    step_ = now_.q - old_.q;
    Eigen::Map<Eigen::VectorXd>(y, now_.q.size()) =
        old_.q + x * step_ + x * (x - 1) * ((1 - 2 * x) * step_ + h * ((x - 1) * from_ + x * to_));
    Eigen::Map<Eigen::VectorXd>(y + now_.q.size(), now_.p.size()) = old_.p + x * (now_.p - old_.p);
    return true;
  }

  /// Takes the step from the last one's start to an output time; the cubic where that does not
  /// converge.
  bool sample(double t, double* y, double*) {
    if (std::abs(t - t1_) <= grid_.tolerance()) return store(now_, y), true;
    if (std::abs(t - t0_) <= grid_.tolerance()) return store(old_, y), true;
    Counters uncounted;
    if (!look_) {
      look_ = std::make_unique<Step>(parts_);
      look_at_ = now_;
    }
    if (!look_->repeat(run_, t0_, old_) || !look_->advance(t0_, t - t0_, old_, look_at_, uncounted))
      return at(t, y, nullptr);
    store(look_at_, y);
    return true;
  }

 private:
  void store(const State& state, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, state.q.size()) = state.q;
    Eigen::Map<Eigen::VectorXd>(y + state.q.size(), state.p.size()) = state.p;
  }

  ConstrainedHamiltonian& parts_;
  FixedGrid grid_;
  Step run_;
  std::unique_ptr<Step> look_;  ///< null until asked for
  std::vector<double> y_;
  State old_, now_, next_, look_at_;
  Eigen::VectorXd from_, to_, step_;
  double t0_, t1_;  ///< the last step [s]
  Counters counters_;
};

/// Runs `Step`. @throws std::invalid_argument with a sentence for a system that is no Hamiltonian,
/// a start of another size, a step that is not positive.
template <class Step>
IntegrationResult integrate(OdeSystem& system, double t0, const std::vector<double>& y0,
                            const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  const std::string name = Step::name();
  auto* parts = dynamic_cast<ConstrainedHamiltonian*>(&system);
  if (parts == nullptr)
    throw std::invalid_argument(name + " takes a Hamiltonian: expected form momentum");
  if (y0.size() != static_cast<std::size_t>(system.size()))
    throw std::invalid_argument("the start state must have the size of the system");
  expect_fixed_step(options, name);
  const OutputCursor outputs(t0, output_times);
  Steps<Step> method(*parts, t0, y0, options.step);
  IntegrationResult result;
  if (!method.start()) {
    result.y = y0;
    result.end_time = t0;
    const std::string singular = parts->without_inverse(t0, y0.data());
    result.reason = stop_sentence(
        name, t0,
        singular.empty() ? "the start has no rates"
                         : "the method takes rates from M u = p, and " + singular +
                               "; expected a method that solves for them with the multipliers, "
                               "as gauss4");
    return result;
  }
  MultistepRun<Steps<Step>>(method, system.size(), t0, output_times, options, observer).run(result);
  result.counters = method.counters();
  return result;
}

}  // namespace momenta::constrained
