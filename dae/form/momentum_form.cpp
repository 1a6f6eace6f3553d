#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/momentum_form.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

MomentumForm::MomentumForm(std::string name, const Mechanism& mechanism, const FormOptions& options,
                           const Start& start, double beta, int solutions)
    : OdeForm(std::move(name), mechanism, options, start),
      gauge_(options.gauge),
      beta_(has_loops() ? beta : 0),
      solutions_(solutions),
      around_(multipliers_.size()) {
  if (!has_loops()) gauge_ = {};
  if (gauge_.kind == Gauge::Kind::leak && gauge_.kappa == 0)
    gauge_.kappa = default_leak(mechanism, start);
  if (has_loops()) solver_->stabilise(beta_);
  if (solutions_ > 1 && start.residue.size() > 0) not_closed_.assign(multipliers_.size(), 0.0);
  e_->place(start.t, start.q.data());
  sizes_.of_momenta(*e_, start, scale_.data() + mechanism.nq());
  if (friction_) return;  // friction needs λ and u̇, which momentum-index1 lacks
  FormOptions equations = options;
  equations.gauge = leak() > 0 ? gauge_ : Gauge{};  // what happens after steps is not in f
  equations.beta = beta_;
  solves(
      [&mechanism, equations, start] { return make_momentum_index1(mechanism, equations, start); });
}

std::vector<double> MomentumForm::initial(const Start& start) {
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

bool MomentumForm::rhs(double t, const double* y, double* ydot) {
  const double *q = y, *p = y + mechanism_.nq();
  double* pdot = ydot + mechanism_.nq();
  if (!has_loops()) {
    if (!e_->open_momentum_rates(t, q, p, u_.data(), pdot))
      return fail_at(t, no_inertia(mechanism_, e_->singular_joint(), t, q));
  } else {
    if (corrects_) {
      place_.assign(q, q + mechanism_.nq());
      if (!correct_position(t, place_.data())) return false;
      q = place_.data();
    }
    if (!solve(t, q, p, pdot)) return false;
    note_pivots();
  }
  if (!add_friction(t, q, pdot)) return false;
  coordinate_rates(q, u_.data(), ydot);
  return true;
}

bool MomentumForm::add_friction(double t, const double* q, double* pdot) {
  if (!friction_) return true;
  if (!add_bearing_friction(t, q, u_.data())) return false;
  for (std::size_t i = 0; i < u_.size(); ++i) pdot[i] += friction_->forces()[i];
  return true;
}

bool MomentumForm::after_step(double t, double* y, bool& changed) {
  double *q = y, *p = y + mechanism_.nq();
  if (has_loops() && options_.project && !correct_position(t, q)) return false;
  normalise(q);
  if (has_loops() && gauge_.kind == Gauge::Kind::reset) {
    if (!solve(t, q, p, nullptr)) return false;
    e_->place(t, q);
    // p − Φ_qᵀσ equals M u, but is rounded once, not on the way to u and back.
    e_->constraint_forces(multipliers_.data(), work_.data());
    for (std::size_t i = 0; i < work_.size(); ++i) p[i] -= work_[i];
    e_->move(u_.data());
    e_->momenta(nullptr, work_.data());
    // (7) at the new state gives the same u, and σ = 0.
    e_->momentum_rates(q, u_.data(), nullptr, 0, work_.data());
    if (!add_friction(t, q, work_.data())) return false;
    coordinate_rates(q, u_.data(), correction_.data());
    changed = true;
    reset_ = solutions_ == 1;
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

bool MomentumForm::first_derivative(double* ydot) {
  if (!reset_) return false;
  reset_ = false;
  std::copy(correction_.begin(), correction_.end(), ydot);
  std::copy(work_.begin(), work_.end(), ydot + mechanism_.nq());
  return true;
}

double MomentumForm::motion_error_squared(double t, const double* y, const double* error,
                                          double rtol, double atol) {
  const int nq = mechanism_.nq();
  if (!solver_->free_velocity(t, y, error + nq, delta_.data()))
    return std::numeric_limits<double>::quiet_NaN();
  return mean_square(y, error, u_.data(), delta_.data(), rtol, atol);
}

void MomentumForm::begin_step(double t, const double* y) {
  OdeForm::begin_step(t, y);
  if (gauge_.kind == Gauge::Kind::reset) return;
  centre_ = multipliers_;
  for (std::size_t i = 0; i < not_closed_.size(); ++i) centre_[i] -= not_closed_[i];
}

void MomentumForm::carry(Memory& memory) {
  OdeForm::carry(memory);
  memory(not_closed_);
}

bool MomentumForm::read(double t, const double* y, const double*, Snapshot& out) {
  const double* p = y + mechanism_.nq();
  const ObservationGuard looking(*this);
  out.q = Eigen::Map<const Eigen::VectorXd>(y, mechanism_.nq());
  const double* q = out.q.data();
  // The correction belongs to the method, so it is applied to interpolated states too.
  if (has_loops() && options_.project && !correct_position(t, out.q.data())) return false;
  if (!has_loops()) {
    if (!e_->open_momentum_rates(t, q, p, u_.data(), work_.data()))
      return fail_at(t, no_inertia(mechanism_, e_->singular_joint(), t, q));
  } else if (!solve(t, q, p, nullptr)) {
    return false;
  }
  out.u = Eigen::Map<const Eigen::VectorXd>(u_.data(), mechanism_.nv());
  out.multipliers = Eigen::Map<const Eigen::VectorXd>(multipliers_.data(), mechanism_.m());
  return true;
}

bool MomentumForm::solve(double t, const double* q, const double* p, double* pdot) {
  const double* centre = gauge_.kind == Gauge::Kind::reset ? nullptr : centre_.data();  // σ = 0
  for (int k = 1; k <= solutions_; ++k) {
    if (!solver_->momentum(t, q, p, centre, fade_evaluation, leak(), u_.data(), multipliers_.data(),
                           k == solutions_ ? pdot : nullptr))
      return solver_failed(t, q, "the solution of (7)");
    if (k == solutions_) break;
    std::copy(multipliers_.begin(), multipliers_.end(), around_.begin());
    centre = around_.data();
  }
  for (std::size_t i = 0; looking_ == 0 && i < not_closed_.size(); ++i)
    not_closed_[i] = solutions_ * (multipliers_[i] - around_[i]);
  return true;
}

}  // namespace momenta
