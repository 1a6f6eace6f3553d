// The energy-momentum scheme of the constraints Φ = 0 and Φ̇ = 0, fixed steps, order 2, symmetric.
//
// The variational principle of Gear, Gupta and Leimkuhler's equations adds both constraints to H,
//
//   K(q, p) = H(q, p) + λᵀΦ(q) + γᵀΦ_q M⁻¹p,      q' = K_p,  p' = −K_q,
//
// and with −γ = σ these are (7), (8) with the force of loops besides, since
// H_σ = ½ (p − Φ_qᵀσ)ᵀM⁻¹(p − Φ_qᵀσ) + V has the same gradient up to O(σ²):
//
//   M u + Φ_qᵀσ = p,     q' = u,  p' = L_q + Q + Φ̇_qᵀσ − Φ_qᵀλ.
//
// A step, everything at its middle q_½ = q_0 ∘ exp(δ/2), p_½ = (p_0 + p_1)/2, with λ, σ constant:
//
//   q_1 = q_0 ∘ exp δ,  δ = h (u + α M⁻¹Δp)                     Φ(q_1) = 0
//   p_1 = p_0 + h (L_q + Q + Φ̇_qᵀσ − Φ_qᵀλ) − α M v/h        Φ_q u_1 = 0 at q_1
//   H(q_1, p_1) = H_start + Σ h P,                              P = Qᵀu of forces without potential
//
// Of all that an increment of H along K's flow can be, K's discrete gradient has what the last line
// asks: Δz = h J (∇K(z_½) + α d), d = (M v/h², M⁻¹Δp), is Gonzalez' with
// α = (ΔK − ∇K(z_½)·Δz)/(d·Δz), d·Δz = vᵀMv/h² + ΔpᵀM⁻¹Δp: of the size of the kinetic energy where
// the mechanism moves, and not zero where it turns. α is O(h²). v is δ but for cyclic coordinates
// (cyclic_coordinates.h), where it is such that M v is zero there: their momenta are constants of
// the step, and δᵀMv = vᵀMv. The energy of step n is held against the start: no roundings add up.
//
// All lines are iterated together by substitution, to rounding, which contracts like h; W = Φ_q
// M⁻¹Φ_qᵀ, of the step's start,
//
//   λ += W⁻¹Φ̇/h,   σ += W⁻¹Φ/h − W⁻¹Φ̇/2,   α += (H − H_wanted)/(u_1·Mv/h + ΔpᵀM⁻¹Δp).
//
// One factorisation of (7) a step, dense or sparse by size. In rows that depend on others the
// multipliers fade to zero.
// Source: Kinon, Betsch, Schneider, Nonlinear Dynamics 111 (2023) 14231-14261; Gonzalez, J.
// Nonlinear Sci. 6 (1996) 449-467, and Comput. Methods Appl. Mech. Eng. 174 (1999) 453-472.

#include <momenta/dae/integrator/constrained_steps.h>
#include <momenta/dae/integrator/cyclic_coordinates.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>

#include <Eigen/Cholesky>

namespace momenta {
namespace {

using constrained::State;
using Eigen::VectorXd;

/// Relative difference of equal energies; part of the energy below which motion is none, and d has
/// no length.
constexpr double energy_rounding = 4 * std::numeric_limits<double>::epsilon();
constexpr double least_motion = 1e-12;
constexpr int first_balance = 3;  ///< first iteration that seeks α
constexpr double settled = 0.1;   ///< relative change of δ and u_1 below which α is sought
constexpr double longest = 0.1;   ///< longest change of α at once

class EnergyMomentum {
 public:
  explicit EnergyMomentum(ConstrainedHamiltonian& parts)
      : parts_(parts),
        here_(parts.place()),
        middle_(parts.place()),
        there_(parts.place()),
        onto_velocities_(parts),
        q_(parts.coordinates()) {
    for (VectorXd* x :
         {&delta_, &half_, &u_, &u1_, &p_, &g_, &force_, &change_of_p_, &lift_, &unused_, &push_})
      *x = VectorXd::Zero(parts.momenta());
    for (VectorXd* x : {&lambda_, &sigma_, &phi_, &rate_, &of_phi_, &of_rate_})
      *x = VectorXd::Zero(parts.multipliers());
  }

  static const char* name() { return "energy-momentum"; }
  const std::string& cause() const { return cause_; }

  bool start(double t, State& state) {
    if (!constrained::go(*here_, t, state) || !onto_velocities_(*here_, state)) return false;
    set_cyclic(cyclic_coordinates(parts_, t, state.q));
    energy_before_ = energy_ = here_->energy(state.q.data(), state.u.data());
    return std::isfinite(energy_);
  }
  void accept() {
    std::swap(here_, there_);
    energy_before_ = energy_;
    energy_ += work_;
  }
  bool repeat(const EnergyMomentum& last, double t, const State& from) {
    lambda_ = last.lambda_, sigma_ = last.sigma_;
    if (cyclic_ != last.cyclic_) set_cyclic(last.cyclic_);
    energy_ = last.energy_before_;
    return constrained::go(*here_, t, from);
  }

  bool advance(double t, double h, const State& from, State& to, Counters& counters) {
    delta_ = h * from.u;
    u1_ = from.u;
    to.p = from.p;
    alpha_ = 0;
    // Angles that have turned many times are rounded by ε |q|; h |u| of them is rounded by less.
    const constrained::Convergence convergence(std::max(1.0, 0.01 * from.q.cwiseAbs().maxCoeff()));
    int count = 0;
    if (!constrained::to_rounding(convergence, counters, cause_,
                                  "the implicit equations of the step did not converge",
                                  [&](double& change) {
                                    if (!iterate(t, h, from, to, change)) return false;
                                    balance(++count, change, h, to);
                                    return true;
                                  }))
      return false;
    return onto_velocities_.at_end(*there_, t + h, to, counters, cause_);
  }

 private:
  bool no_mass() {
    cause_ = "the mass matrix is not positive definite";
    return false;
  }

  /// All lines once; `change`: the largest of δ and of u_1 h.
  bool iterate(double t, double h, const State& from, State& to, double& change) {
    half_ = 0.5 * delta_;
    parts_.move(from.q.data(), half_.data(), q_.data());
    if (!middle_->at(t + 0.5 * h, q_.data())) return no_mass();
    p_ = 0.5 * (from.p + to.p);
    middle_->rates(p_.data(), sigma_.data(), u_.data());
    middle_->force(q_.data(), u_.data(), sigma_.data(), g_.data());
    work_ = h * middle_->power(q_.data(), u_.data());
    change_of_p_ = to.p - from.p;
    lift_ = change_of_p_;
    middle_->solve_mass(lift_.data());

    half_ = delta_;
    delta_ = h * (u_ + alpha_ * lift_);
    weigh();
    to.p = from.p + h * g_ - (alpha_ / h) * push_;
    if (lambda_.size() > 0) {
      middle_->constraint_forces(lambda_.data(), force_.data());
      to.p -= h * force_;
    }
    parts_.move(from.q.data(), delta_.data(), to.q.data());
    if (!there_->at(t + h, to.q.data())) return no_mass();
    u_ = u1_;
    there_->rates(to.p.data(), nullptr, u1_.data());
    change = std::max((delta_ - half_).cwiseAbs().maxCoeff(), h * (u1_ - u_).cwiseAbs().maxCoeff());
    if (lambda_.size() > 0 && !constrain(h)) return false;
    return true;
  }

  void set_cyclic(std::vector<int> cyclic) {
    cyclic_ = std::move(cyclic);
    const auto count = static_cast<Eigen::Index>(cyclic_.size());
    columns_ = Eigen::MatrixXd::Zero(push_.size(), count);
    block_.compute(Eigen::MatrixXd::Identity(count, count));  // takes the memory it needs
    among_ = Eigen::MatrixXd::Zero(count, count);
    of_cyclic_ = VectorXd::Zero(count);
  }
  /// M v of δ, in the middle.
  void weigh() {
    middle_->mass_times(delta_.data(), push_.data());
    if (cyclic_.empty()) return;
    const auto count = static_cast<Eigen::Index>(cyclic_.size());
    for (Eigen::Index k = 0; k < count; ++k) {
      unused_.setZero();
      unused_[at(k)] = 1;
      middle_->mass_times(unused_.data(), columns_.col(k).data());
    }
    for (Eigen::Index k = 0; k < count; ++k) {
      among_.row(k) = columns_.row(at(k));
      of_cyclic_[k] = push_[at(k)];
    }
    block_.compute(among_);
    of_cyclic_ = block_.solve(of_cyclic_);
    push_.noalias() -= columns_ * of_cyclic_;
    for (Eigen::Index k = 0; k < count; ++k) push_[at(k)] = 0;
  }
  Eigen::Index at(Eigen::Index k) const { return cyclic_[static_cast<std::size_t>(k)]; }

  /// λ and σ by Φ and Φ̇ at the end.
  bool constrain(double h) {
    there_->positions(phi_.data());
    there_->velocities(u1_.data(), rate_.data());
    if (!here_->correction(phi_.data(), unused_.data(), of_phi_.data()) ||
        !here_->correction(rate_.data(), unused_.data(), of_rate_.data()))
      return false;
    lambda_ += of_rate_ / h;
    sigma_ += of_phi_ / h - 0.5 * of_rate_;
    return true;
  }

  /// α by the energy at the end. Before Δp and λ are known to their first figure, an excess of
  /// energy is theirs.
  void balance(int count, double change, double h, const State& to) {
    if (count < first_balance ||
        change > settled * std::max(delta_.cwiseAbs().maxCoeff(), h * u1_.cwiseAbs().maxCoeff()))
      return;
    const double found = there_->energy(to.q.data(), u1_.data()), excess = found - energy_ - work_;
    const double scale = std::abs(found) + there_->kinetic();
    const double turning = change_of_p_.dot(lift_),
                 along = std::max(u1_.dot(push_) / h, delta_.dot(push_) / (2 * h * h)) + turning;
    if (!(std::abs(excess) <= energy_rounding * scale) && !(along <= least_motion * scale))
      alpha_ += std::clamp(excess / along, -longest, longest);
  }

  ConstrainedHamiltonian& parts_;
  std::unique_ptr<HamiltonianPlace> here_, middle_, there_;
  constrained::OntoVelocities onto_velocities_;
  VectorXd lambda_, sigma_, phi_, rate_, of_phi_, of_rate_;
  VectorXd q_, delta_, half_, u_, u1_, p_, g_, force_, change_of_p_, lift_, unused_, push_;
  std::vector<int> cyclic_;          ///< places in p
  Eigen::MatrixXd columns_, among_;  ///< cyclic columns of M, and cyclic rows of these
  Eigen::LDLT<Eigen::MatrixXd> block_;
  VectorXd of_cyclic_;
  double alpha_ = 0;
  double energy_ = 0, energy_before_ = 0;  ///< wanted at this step's start, at the last one's [J]
  double work_ = 0;                        ///< work of forces without potential in this step [J]
  std::string cause_;
};

}  // namespace

IntegrationResult integrate_energy_momentum(OdeSystem& system, double t0,
                                            const std::vector<double>& y0,
                                            const std::vector<double>& output_times,
                                            const IntegrationOptions& options,
                                            const Observer& observer) {
  const auto* parts = dynamic_cast<ConstrainedHamiltonian*>(&system);
  if (const std::string what = parts != nullptr ? parts->prescribed() : ""; !what.empty())
    throw std::invalid_argument("energy-momentum balances the work of forces alone: found " + what +
                                ", and it does work too; expected no prescribed motion");
  return constrained::integrate<EnergyMomentum>(system, t0, y0, output_times, options, observer);
}

Integrator energy_momentum_integrator() {
  return {.name = "energy-momentum",
          .method = "energy-momentum scheme, order 2",
          .forms = {"momentum"},
          .closes = {"momentum"},
          .hamiltonian = true,
          .ode_run = integrate_energy_momentum};
}

}  // namespace momenta
