// RATTLE for a Hamiltonian that is not separable, with fixed steps: the index-3 equations
// (5a)-(5c), positions and velocities on their constraints after every step,
//
//   p_½ = p_n + h/2 (g(q_n, u_0) − Φ_qᵀ(q_n) λ),          M(q_n) u_0 = p_½
//   q_{n+1} = q_n ∘ exp(h/2 u_0) ∘ exp(h/2 u_1),          M(q_{n+1}) u_1 = p_½,  Φ(q_{n+1}) = 0
//   p_{n+1} = p_½ + h/2 (g(q_{n+1}, u_1) − Φ_qᵀ(q_{n+1}) μ),   Φ_q u_{n+1} + Φ_t = 0,
//
// g = L_q + Q. Order 2, symmetric; symplectic on the constraint manifold where q' = u. It is the
// Lobatto IIIA-IIIB pair of two stages; the last line resets the gauge: no σ is in p.
//
// The first two lines are iterated together to rounding: u_0, u_1 and q by substitution, which
// contracts like h, and λ by
//
//   λ += 2/h² ν,   M δ + Φ_qᵀν = 0,  Φ_q δ = −Φ(q_{n+1}),   M and Φ_q at q_n,
//
// off from the derivative of Φ(q_{n+1}) by O(h), so that it contracts like that too. The matrix is
// that of the last line one step before: one factorisation a step, of (7), dense or sparse. Rows
// that depend on others get multipliers that fade to zero.
// Source: Andersen, J. Comput. Phys. 52 (1983) 24-34; Jay, SIAM J. Numer. Anal. 33 (1996) 368-387;
// Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.

#include <momenta/dae/integrator/constrained_steps.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>

namespace momenta {
namespace {

using constrained::State;
using Eigen::VectorXd;

class Rattle {
 public:
  explicit Rattle(ConstrainedHamiltonian& parts)
      : parts_(parts),
        here_(parts.place()),
        there_(parts.place()),
        onto_velocities_(parts),
        middle_(parts.coordinates()) {
    for (VectorXd* x : {&u0_, &u1_, &u0_before_, &u1_before_, &g_, &delta_, &force_})
      *x = VectorXd::Zero(parts.momenta());
    for (VectorXd* x : {&lambda_, &phi_, &nu_}) *x = VectorXd::Zero(parts.multipliers());
  }

  static const char* name() { return "rattle"; }
  const std::string& cause() const { return cause_; }

  bool start(double t, State& state) {
    return constrained::go(*here_, t, state) && onto_velocities_(*here_, state);
  }
  void accept() { std::swap(here_, there_); }
  bool repeat(const Rattle& last, double t, const State& from) {
    lambda_ = last.lambda_;
    return constrained::go(*here_, t, from);
  }

  bool advance(double t, double h, const State& from, State& to, Counters& counters) {
    u0_ = u1_ = from.u;
    const double size = 1 + from.q.cwiseAbs().maxCoeff();
    if (!constrained::to_rounding(constrained::Convergence(), counters, cause_,
                                  "the implicit stages did not converge", [&](double& change) {
                                    if (!iterate(t, h, from, to, change)) return false;
                                    change /= size;
                                    return true;
                                  }))
      return false;
    ++counters.evaluations;
    there_->force(to.q.data(), u1_.data(), nullptr, g_.data());
    to.p += 0.5 * h * g_;
    return onto_velocities_.at_end(*there_, t + h, to, counters, cause_);
  }

 private:
  /// Iterates the first two lines once, p_½ in to.p; `change`: the largest of q.
  bool iterate(double t, double h, const State& from, State& to, double& change) {
    here_->force(from.q.data(), u0_.data(), nullptr, g_.data());
    to.p = from.p + 0.5 * h * g_;
    if (lambda_.size() > 0) {
      here_->constraint_forces(lambda_.data(), force_.data());
      to.p -= 0.5 * h * force_;
    }
    u0_before_ = u0_, u1_before_ = u1_;
    here_->rates(to.p.data(), nullptr, u0_.data());
    u1_ += u0_ - u0_before_;  // u_1 follows p_½ too: λ's correction counts on both
    delta_ = 0.5 * h * u0_;
    parts_.move(from.q.data(), delta_.data(), middle_.data());
    delta_ = 0.5 * h * u1_;
    parts_.move(middle_.data(), delta_.data(), to.q.data());
    if (!there_->at(t + h, to.q.data())) {
      cause_ = "the mass matrix is not positive definite";
      return false;
    }
    there_->rates(to.p.data(), nullptr, u1_.data());
    change = h * std::max((u0_ - u0_before_).cwiseAbs().maxCoeff(),
                          (u1_ - u1_before_).cwiseAbs().maxCoeff());
    if (lambda_.size() == 0) return true;
    there_->positions(phi_.data());
    if (!here_->correction(phi_.data(), delta_.data(), nu_.data())) return false;
    lambda_ += 2 / (h * h) * nu_;
    change = std::max(change, delta_.cwiseAbs().maxCoeff());
    return true;
  }

  ConstrainedHamiltonian& parts_;
  std::unique_ptr<HamiltonianPlace> here_, there_;
  constrained::OntoVelocities onto_velocities_;
  VectorXd lambda_, u0_, u1_, u0_before_, u1_before_, g_, delta_, force_, middle_, phi_, nu_;
  std::string cause_;
};

}  // namespace

IntegrationResult integrate_rattle(OdeSystem& system, double t0, const std::vector<double>& y0,
                                   const std::vector<double>& output_times,
                                   const IntegrationOptions& options, const Observer& observer) {
  return constrained::integrate<Rattle>(system, t0, y0, output_times, options, observer);
}

Integrator rattle_integrator() {
  return {.name = "rattle",
          .method = "RATTLE, order 2",
          .forms = {"momentum"},
          .closes = {"momentum"},
          .hamiltonian = true,
          .ode_run = integrate_rattle};
}

}  // namespace momenta
