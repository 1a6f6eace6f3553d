// acceleration
//
// Unknowns      q, u
// Equations     (3): M u̇ + Φ_qᵀλ = Q + L_q − Ṁ u,  Φ_q u̇ = −Φ̇_q u − Φ̇_t;  q̇ = u
// Index         an ODE
// Hidden        Φ(q, t) = 0 and Φ_q u + Φ_t = 0
// Multipliers   λ, a force
// Drifts        Φ̇ like t, Φ like t²: Φ̈ = 0 is integrated twice
// Projection    with --project, one mass-metric correction of q and then of u after each step
// Source        paper, eqs. (2), (3).
//
// baumgarte
//
// Equations     the same with Φ̈ + 2α Φ̇ + β² Φ = 0 in the second row
// Drifts        Φ and Φ̇ stay bounded, at a level set by α, β and the step; energy is not conserved
// by the correction Gains         α = β = 1/T unless given, critically damped, T the mechanism's
// own time scale (default_leak's): larger
//               gains make an explicit method stiff, smaller ones let the loops open
// Source        Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972).

#include <momenta/dae/form/ode_form.h>

#include <algorithm>

namespace momenta {
namespace {

class Acceleration final : public OdeForm {
 public:
  Acceleration(std::string name, const Mechanism& mechanism, const FormOptions& options,
               double alpha, double beta)
      : OdeForm(std::move(name), mechanism, options),
        alpha_(alpha),
        beta_(beta),
        nu_(multipliers_.size()) {}

  bool momentum_like() const override { return false; }

  std::vector<double> initial(const Start& start) override {
    std::vector<double> y(start.q.begin(), start.q.end());
    y.insert(y.end(), start.u.begin(), start.u.end());
    for (std::size_t i = 0; i < multipliers_.size(); ++i)
      multipliers_[i] = start.lambda[static_cast<Eigen::Index>(i)];
    centre_ = multipliers_;
    return y;
  }

  bool rhs(double t, const double* y, double* ydot) override {
    const double *q = y, *u = y + mechanism_.nq();
    double* udot = ydot + mechanism_.nq();
    if (!has_loops()) {
      if (!e_->open_accelerations(t, q, u, udot))
        return fail_at(t, mechanism_.no_inertia(e_->stuck()));
      e_->coordinate_rates(q, u, ydot);
      return true;
    }
    if (!solver_->acceleration(t, q, u, centre_.data(), alpha_, beta_, udot, multipliers_.data()))
      return solver_failed(t, q, "the solution of (3)");
    note_pivots();
    e_->coordinate_rates(q, u, ydot);
    return true;
  }

  bool has_after_step() const override {
    return (has_loops() && options_.project) || mechanism_.plan().quasi_velocities;
  }
  bool after_step(double t, double* y, bool&) override {
    double *q = y, *u = y + mechanism_.nq();
    if (has_loops() && options_.project && !(correct_position(t, q) && correct_velocity(t, q, u)))
      return false;
    normalise(q);
    return true;
  }
  void begin_step(double t, const double* y) override {
    OdeForm::begin_step(t, y);
    centre_ = multipliers_;
  }
  bool wants_care() const override { return false; }

  bool read(double t, const double* y, const double*, Snapshot& out) override {
    const Looking looking(*this);
    const std::vector<double> kept = multipliers_;
    std::vector<double> state(y, y + size()), rates(state.size());
    double *q = state.data(), *u = q + mechanism_.nq();
    // The correction belongs to the method, so it is applied to interpolated states too.
    if (has_loops() && options_.project && !(correct_position(t, q) && correct_velocity(t, q, u)))
      return false;
    if (!rhs(t, state.data(), rates.data())) return false;
    out.q = Eigen::Map<const Eigen::VectorXd>(q, mechanism_.nq());
    out.u = Eigen::Map<const Eigen::VectorXd>(u, mechanism_.nv());
    out.multipliers = Eigen::Map<const Eigen::VectorXd>(multipliers_.data(), mechanism_.m());
    multipliers_ = kept;  // looking on must not move the centre of later steps
    return true;
  }
  std::pair<double, double> baumgarte_gains() const override { return {alpha_, beta_}; }

 private:
  /// M v + Φ_qᵀν = M u, Φ_q v = −Φ_t: the nearest consistent velocity in the mass metric.
  bool correct_velocity(double t, const double* q, double* u) {
    e_->place(t, q);
    e_->move(u);
    e_->momenta(nullptr, work_.data());
    if (!solver_->momentum(t, q, work_.data(), nullptr, fade_projection, 0, u_.data(), nu_.data(),
                           nullptr))
      return solver_failed(t, q, "the velocity correction");
    std::copy(u_.begin(), u_.end(), u);
    return true;
  }

  double alpha_, beta_;
  std::vector<double> nu_;
};

}  // namespace

std::unique_ptr<OdeForm> make_acceleration(const Mechanism& mechanism, const FormOptions& options,
                                           const Start&) {
  return std::make_unique<Acceleration>("acceleration", mechanism, options, 0, 0);
}

std::unique_ptr<OdeForm> make_baumgarte(const Mechanism& mechanism, const FormOptions& options,
                                        const Start& start) {
  const double own = default_leak(mechanism, start);
  return std::make_unique<Acceleration>("baumgarte", mechanism, options,
                                        options.baumgarte_alpha > 0 ? options.baumgarte_alpha : own,
                                        options.baumgarte_beta > 0 ? options.baumgarte_beta : own);
}

}  // namespace momenta
