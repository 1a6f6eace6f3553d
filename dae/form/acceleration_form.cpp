#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <limits>

namespace momenta {

AccelerationForm::AccelerationForm(std::string name, const Mechanism& mechanism,
                                   const FormOptions& options, const Start& start,
                                   Feedback feedback, int solutions)
    : OdeForm(std::move(name), mechanism, options, start),
      feedback_(feedback),
      solutions_(solutions),
      nu_(multipliers_.size()),
      at_rest_(u_.size()) {
  push_friction();
  approaching_ = 0.05;  // no gauge hides in q and u: the plain norm serves longer
  solves([&mechanism, options, start, feedback] {
    return make_acceleration_index1_with(feedback, mechanism, options, start);
  });
}

std::vector<double> AccelerationForm::initial(const Start& start) {
  std::vector<double> y(start.q.begin(), start.q.end());
  y.insert(y.end(), start.u.begin(), start.u.end());
  std::copy(start.lambda.begin(), start.lambda.end(), multipliers_.begin());
  centre_ = multipliers_;
  return y;
}

bool AccelerationForm::rhs(double t, const double* y, double* ydot) {
  const double *q = y, *u = y + mechanism_.nq();
  double* udot = ydot + mechanism_.nq();
  if (!has_loops()) {
    if (!add_bearing_friction(t, q, u)) return false;
    if (!e_->open_accelerations(t, q, u, udot))
      return fail_at(t, no_inertia(mechanism_, e_->singular_joint(), t, q));
    coordinate_rates(q, u, ydot);
    return true;
  }
  if (corrects_stages_) {
    state_.assign(y, y + size());
    double *near_q = state_.data(), *near_u = near_q + mechanism_.nq();
    if (!AccelerationForm::correct(t, near_q, near_u)) return false;
    q = near_q;
    u = near_u;
  }
  if (!add_bearing_friction(t, q, u)) return false;
  const double* centre = centre_.data();
  for (int k = 0; k < solutions_; ++k) {
    if (!solver_->acceleration(t, q, u, centre, feedback_.alpha, feedback_.beta, udot,
                               multipliers_.data()))
      return solver_failed(t, q, "the solution of (3)");
    if (k + 1 == solutions_) break;
    std::copy(multipliers_.begin(), multipliers_.end(), nu_.begin());
    centre = nu_.data();
  }
  note_pivots();
  coordinate_rates(q, u, ydot);
  return true;
}

bool AccelerationForm::after_step(double t, double* y, bool&) {
  double *q = y, *u = y + mechanism_.nq();
  if (corrects() && !correct(t, q, u)) return false;
  normalise(q);
  return true;
}

bool AccelerationForm::read(double t, const double* y, const double*, Snapshot& out) {
  const ObservationGuard looking(*this);
  std::vector<double> state(y, y + size()), rates(state.size());
  double *q = state.data(), *u = q + mechanism_.nq();
  // The correction belongs to the method, so it is applied to interpolated states too.
  if (corrects() && !correct(t, q, u)) return false;
  if (!rhs(t, state.data(), rates.data())) return false;
  out.q = Eigen::Map<const Eigen::VectorXd>(q, mechanism_.nq());
  out.u = Eigen::Map<const Eigen::VectorXd>(u, mechanism_.nv());
  out.multipliers = Eigen::Map<const Eigen::VectorXd>(multipliers_.data(), mechanism_.m());
  return true;
}

bool AccelerationForm::correct_velocity(double t, const double* q, double* u) {
  e_->place(t, q);
  e_->move(u);
  e_->momenta(nullptr, work_.data());
  if (!solver_->momentum(t, q, work_.data(), nullptr, fade_projection, 0, u_.data(), nu_.data(),
                         nullptr))
    return solver_failed(t, q, "the velocity correction");
  std::copy(u_.begin(), u_.end(), u);
  return true;
}

double AccelerationForm::motion_error_squared(double t, const double* y, const double* error,
                                              double rtol, double atol) {
  const int nq = mechanism_.nq();
  // M e_u, without the drives' part of p.
  e_->place(t, y);
  e_->move(at_rest_.data());
  e_->momenta(nullptr, delta_.data());
  e_->move(error + nq);
  e_->momenta(nullptr, work_.data());
  for (std::size_t i = 0; i < work_.size(); ++i) work_[i] -= delta_[i];
  if (!solver_->free_velocity(t, y, work_.data(), delta_.data()))
    return std::numeric_limits<double>::quiet_NaN();
  return mean_square(y, error, y + nq, delta_.data(), rtol, atol);
}

Feedback feedback_of(const Mechanism& mechanism, const FormOptions& options, const Start& start) {
  const double own = default_leak(mechanism, start);
  return {options.baumgarte_alpha > 0 ? options.baumgarte_alpha : own,
          options.baumgarte_beta > 0 ? options.baumgarte_beta : own};
}

}  // namespace momenta
