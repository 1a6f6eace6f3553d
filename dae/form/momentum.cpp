// momentum
//
// Unknowns      q, p
// Equations     (7) solved for u and σ at every evaluation, then (8):
//                 M u + Φ_qᵀσ = p,  Φ_q u = −Φ_t;  q̇ = u,  ṗ = L_q + Q + Φ̇_qᵀσ − κ Φ_qᵀσ
//               Here p = ∂L*/∂u of the augmented Lagrangian (6): (34) plus Φ_qᵀσ, not the p of (4).
// Index         an ODE on all of R²ⁿ: any p is consistent
// Hidden        Φ(q, t) = 0
// Multipliers   σ, an impulse; the constraint force is λ = σ̇ + κ σ
// Drifts        Φ like t, because Φ̇ = 0 holds to rounding at every evaluation and only its integral
// errs. Without a
//               gauge σ grows like t under a mean load, the local error with it, and Φ like t².
// Gauge         none; leak κ; reset (p ← M u, σ ← 0 after each step: exact, since the gauge is a
//               symmetry); flip (p −= 2 Φ_qᵀσ, σ ← −σ after each step: σ swings about zero. An
//               involution R that commutes with reversal of time: a symmetric method stays
//               reversible, which reset, a projection, spoils. Both keep dq∧dp on Φ_q dq = 0.)
// Without loops there is no σ: (q, p) → (q̇, ṗ) is the recursion (35)-(48),
// momentum_recursion.h. Source        Naudet, Lefeber, Terze, eqs. (6)-(8); Bayo, Avello, Nonlinear
// Dynamics 5 (1994).

#include <momenta/dae/form/hamiltonian_parts.h>
#include <momenta/dae/form/ode_form.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

class Momentum final : public OdeForm, public HamiltonianParts {
 public:
  Momentum(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : OdeForm("momentum", mechanism, options), HamiltonianParts(mechanism) {
    gauge_ = options.gauge;
    if (!has_loops()) gauge_ = {};
    if (gauge_.kind == Gauge::Kind::leak && gauge_.kappa == 0)
      gauge_.kappa = default_leak(mechanism, start);
    // A momentum is as large as its own inertia times a rate of 1 rad/s or 1 m/s.
    e_->place(start.t, start.q.data());
    e_->mass_diagonal(scale_.data() + mechanism.nq());
  }

  bool momentum_like() const override { return true; }
  Gauge gauge() const override { return gauge_; }

  std::vector<double> initial(const Start& start) override {
    std::vector<double> y(static_cast<std::size_t>(size()));
    std::copy(start.q.begin(), start.q.end(), y.begin());
    if (gauge_.kind == Gauge::Kind::leak)  // σ(0) = λ(0)/κ: no transient
      for (std::size_t i = 0; i < multipliers_.size(); ++i)
        multipliers_[i] = start.lambda[static_cast<Eigen::Index>(i)] / gauge_.kappa;
    centre_ = multipliers_;
    e_->place(start.t, start.q.data());
    e_->move(start.u.data());
    e_->momenta(has_loops() ? multipliers_.data() : nullptr, y.data() + mechanism_.nq());
    return y;
  }

  bool rhs(double t, const double* y, double* ydot) override {
    const double *q = y, *p = y + mechanism_.nq();
    double* pdot = ydot + mechanism_.nq();
    if (!has_loops()) {
      if (!e_->open_momentum_rates(t, q, p, u_.data(), pdot))
        return fail_at(t, mechanism_.no_inertia(e_->stuck()));
    } else {
      if (careful_) {
        place_.assign(q, q + mechanism_.nq());
        if (!correct_position(t, place_.data())) return false;
        q = place_.data();
      }
      if (!solve(t, q, p, pdot)) return false;
      note_pivots();
    }
    e_->coordinate_rates(q, u_.data(), ydot);
    return true;
  }

  bool has_after_step() const override {
    return (has_loops() && (options_.project || gauge_.kind == Gauge::Kind::reset ||
                            gauge_.kind == Gauge::Kind::flip)) ||
           mechanism_.plan().quasi_velocities;
  }
  bool after_step(double t, double* y, bool& changed) override {
    double *q = y, *p = y + mechanism_.nq();
    if (has_loops() && options_.project && !correct_position(t, q)) return false;
    normalise(q);
    if (has_loops() && gauge_.kind == Gauge::Kind::reset) {
      if (!solve(t, q, p, nullptr)) return false;
      e_->place(t, q);
      e_->move(u_.data());
      e_->momenta(nullptr, p);
      // (7) at the new state gives the same u, and σ = 0.
      e_->momentum_rates(q, u_.data(), nullptr, 0, work_.data());
      e_->coordinate_rates(q, u_.data(), correction_.data());
      changed = reset_ = true;
    }
    if (has_loops() && gauge_.kind == Gauge::Kind::flip) {
      if (!solve(t, q, p, nullptr)) return false;
      e_->place(t, q);
      e_->constraint_forces(multipliers_.data(), work_.data());
      for (std::size_t i = 0; i < work_.size(); ++i) p[i] -= 2 * work_[i];
      for (double& sigma : multipliers_) sigma = -sigma;
      changed = true;
    }
    return true;
  }
  bool first_derivative(double* ydot) override {
    if (!reset_) return false;
    reset_ = false;
    std::copy(correction_.begin(), correction_.end(), ydot);
    std::copy(work_.begin(), work_.end(), ydot + mechanism_.nq());
    return true;
  }

  void take_care(bool careful) override { careful_ = careful; }
  double motion_error_squared(double t, const double* y, const double* error, double rtol,
                              double atol) override {
    const int nq = mechanism_.nq();
    if (!solver_->free_velocity(t, y, error + nq, delta_.data()))
      return std::numeric_limits<double>::quiet_NaN();
    double sum = 0;
    for (int i = 0; i < nq; ++i) {
      const double e = error[i] / (atol + rtol * std::abs(y[i]));
      sum += e * e;
    }
    for (std::size_t i = 0; i < delta_.size(); ++i) {
      const double e = delta_[i] / (atol + rtol * std::abs(u_[i]));
      sum += e * e;
    }
    return sum / size();
  }

  void begin_step(double t, const double* y) override {
    OdeForm::begin_step(t, y);
    if (gauge_.kind == Gauge::Kind::reset)
      std::fill(centre_.begin(), centre_.end(), 0.0);
    else
      centre_ = multipliers_;
  }

  bool read(double t, const double* y, const double*, Snapshot& out) override {
    const double* p = y + mechanism_.nq();
    const Looking looking(*this);
    const std::vector<double> kept = multipliers_;
    out.q = Eigen::Map<const Eigen::VectorXd>(y, mechanism_.nq());
    const double* q = out.q.data();
    // The correction belongs to the method, so it is applied to interpolated states too.
    if (has_loops() && options_.project && !correct_position(t, out.q.data())) return false;
    if (!has_loops()) {
      if (!e_->open_momentum_rates(t, q, p, u_.data(), work_.data())) return false;
    } else if (!solve(t, q, p, nullptr)) {
      return false;
    }
    out.u = Eigen::Map<const Eigen::VectorXd>(u_.data(), mechanism_.nv());
    out.multipliers = Eigen::Map<const Eigen::VectorXd>(multipliers_.data(), mechanism_.m());
    multipliers_ = kept;  // looking on must not move the centre of later steps
    return true;
  }

 private:
  double leak() const { return gauge_.kind == Gauge::Kind::leak ? gauge_.kappa : 0.0; }

  /// (7): u_ and multipliers_; with `pdot` (8) too.
  bool solve(double t, const double* q, const double* p, double* pdot) {
    return solver_->momentum(t, q, p, centre_.data(), fade_evaluation, leak(), u_.data(),
                             multipliers_.data(), pdot) ||
           solver_failed(t, q, "the solution of (7)");
  }

  Gauge gauge_;
  bool careful_ = false;
  bool reset_ = false;  ///< work_ and correction_ hold f after a reset
  std::vector<double> place_;
};

}  // namespace

std::unique_ptr<OdeForm> make_momentum(const Mechanism& mechanism, const FormOptions& options,
                                       const Start& start) {
  return std::make_unique<Momentum>(mechanism, options, start);
}

}  // namespace momenta
