#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/run/measure/growth.h>
#include <momenta/dae/run/run_monitor.h>
#include <momenta/dae/run/run_quantities.h>

#include <algorithm>
#include <cmath>

namespace momenta {

RunMonitor::RunMonitor(const Mechanism& mechanism, const IntegratedScene& scene, Form& form,
                       const Start& start, const RunRequest& request, RunResult& result,
                       RigidStops* stops)
    : mechanism_(mechanism),
      form_(&form),
      request_(request),
      result_(result),
      e_(mechanism.evaluation<double>()),
      stops_(stops),
      residue_(start.residue),
      phi_(mechanism.m()),
      middle_(mechanism.nq()),
      errors_(mechanism, request.reference, result.settings.end_time, result.series),
      row_(mechanism, request.reactions || errors_.takes_reactions()),
      works_(IntegratedWork::has_any(mechanism)),
      limits_(mechanism),
      departures_(mechanism, result.settings, result.settings.end_time - start.t) {
  if (request.keep_trajectory)
    result.trajectory.columns = trajectory_columns(mechanism, request.reactions);
  if (mechanism.m() > 0) {
    result.drift_unit = mechanism.has_lengths() ? "m" : "rad";
    apart_.emplace(mechanism, result.settings);
    solver_ = make_loop_solver(mechanism, *e_);
  }
  drives_.emplace(mechanism, *e_, solver_.get());
  friction_ = bearing_friction(mechanism);
  const bool compares_forces =
      request.reference && (request.reference->has_forces() || errors_.takes_reactions() ||
                            request.reference->has(Reference::Kind::impulse));
  if (request.reference && request.reference->has(Reference::Kind::momentum))
    errors_.measure_momenta(*e_, solver_.get());
  if (request.keep_trajectory || compares_forces || request.multipliers)
    row_.take_forces_of(mechanism, *e_, solver_.get());
  const Mechanism& integrated = scene.mechanism();
  if (scene.anew()) {
    written_.emplace(mechanism, start, scene.folded(), integrated);
    of_form_.q.resize(integrated.nq());
    integrated_e_ = integrated.evaluation<double>();
    integrated_solver_ = make_loop_solver(integrated, *integrated_e_);
  } else if (mechanism.m() > 0 && !stops && (compares_forces || request.multipliers)) {
    errors_.measure_own(form);
  }
  if (integrated.m() > 0 && !stops && integrated.solver().filters_pivots())
    singular_crossings_.emplace(integrated, form, written_ ? *integrated_e_ : *e_,
                                written_ ? *integrated_solver_ : *solver_, result);
  const bool looks = request.events && !mechanism.scene().events.empty();
  if (looks || stops)
    events_.emplace(
        mechanism, looks ? mechanism.scene().events : std::vector<EventSpec>{},
        result.settings.end_time - start.t,
        [this](double t, bool exact, bool rates, const Eigen::VectorXd*& q,
               const Eigen::VectorXd*& u) { return read_at(t, exact, rates, q, u); },
        stops);
  if (stops) go_on(start.t, form);
}

void RunMonitor::go_on(double t, Form& form) {
  form_ = &form;
  exact_ = nullptr;
  const Mechanism& acting = stops_->acting();
  acting_e_ = acting.evaluation<double>();
  acting_solver_ = acting.m() > 0 ? make_loop_solver(acting, *acting_e_) : nullptr;
  drives_.emplace(acting, *acting_e_, acting_solver_.get());
  if (row_.forces()) row_.take_forces_of(acting, *acting_e_, acting_solver_.get());
  hit_.reset();
  events_->restart(t);
}

bool RunMonitor::read(double t, const double* y, const double* ydot) {
  Snapshot& of_form = written_ ? of_form_ : now_;
  if (!form_->read(t, y, ydot, of_form)) return false;
  if (written_) {
    written_->read(t, of_form.q, of_form.u, now_.q, now_.u);
    now_.multipliers = of_form.multipliers;
  }
  mechanism_.tree().normalise(now_.q);
  return true;
}

bool RunMonitor::sample(double t, const double* y, const double* ydot) {
  if (!read(t, y, ydot)) {
    trouble_ = "at t = " + std::to_string(t) + " s the velocities cannot be read back";
    Eigen::VectorXd u(mechanism_.nv()), none = u, pdot = u;
    none.setZero();
    const bool by_mass_alone = mechanism_.m() == 0 || mechanism_.scene().lagrangian.has_value();
    if (const DaeSystem* dae = form_->dae(); dae && !dae->failure().empty())
      trouble_ += ": " + dae->failure();
    else if (!written_ && by_mass_alone &&
             !e_->open_momentum_rates(t, y, none.data(), u.data(), pdot.data()))
      trouble_ += ": " + no_inertia(mechanism_, e_->singular_joint(), t, y);
    else if (const OdeSystem* ode = form_->ode(); ode && !ode->failure().empty())
      trouble_ = ode->failure();
    return false;
  }
  const Drift position = position_drift(t, now_.q);
  if (apart_) fastest_ = std::max(fastest_, apart_->speed(now_.u));
  if (apart_ && position.finite()) {
    came_apart_ = apart_->found(t, phi_, true);
    keep_closed(t, now_.q);
  }
  const Measured now = measure(t, position);
  if (!position.finite() || !now.velocity.finite()) {
    trouble_ = "at t = " + std::to_string(t) + " s the state is not finite";
    return false;
  }
  note(t, now);
  if (!keep_row(t, now)) return false;
  if (request_.film_intervals > 0 && result_.film.frames.empty()) {
    result_.film.start = t;
    result_.film.every = (result_.settings.end_time - t) / request_.film_intervals;
    result_.film.frames.emplace_back(now_.q.begin(), now_.q.end());
  }
  if (!came_apart_.empty()) return false;
  return !request_.progress || request_.progress(t);
}

/// Drift of Φ less what the start leaves open.
Drift RunMonitor::position_drift(double t, const Eigen::VectorXd& q) {
  e_->place(t, q.data());
  e_->positions(phi_.data());
  if (residue_.size() == 0) return drift_of(mechanism_, phi_);
  drift_ = phi_ - residue_;
  return drift_of(mechanism_, drift_);
}

RunMonitor::Measured RunMonitor::measure(double t, const Drift& position) {
  Measured now;
  now.position = position;
  e_->move(now_.u.data());
  e_->velocities(phi_.data());
  now.velocity = drift_of(mechanism_, phi_);
  now.kinetic = e_->kinetic();
  now.potential = e_->potential(now_.q.data());
  now.energy = now.kinetic + now.potential - work_.until(t);
  return now;
}

/// Appends to the series of charts.
void RunMonitor::note(double t, const Measured& now) {
  Series& s = result_.series;
  if (s.t.empty()) {
    limits_.look(t, now_.q.data(), result_.passed_limits);
    energy_at_start_ = now.energy;
    potential_at_start_ = now.potential;
  }
  const double exchanged = now.kinetic + std::abs(now.potential - potential_at_start_);
  if (!(now.kinetic <= result_.kinetic_energy_max)) result_.kinetic_energy_max = now.kinetic;
  if (!(exchanged <= result_.energy_scale)) result_.energy_scale = exchanged;
  departures_.look_at_energy(t, std::abs(now.kinetic) + std::abs(now.potential), exchanged,
                             work_.turned_over(), std::abs(now.energy - energy_at_start_));
  if (apart_) {
    Eigen::Index row = 0;
    const double opening = apart_->gap(phi_, row);
    departures_.look_at_rates(t, opening, row, apart_->speed(now_.u));
  }
  s.t.push_back(t);
  s.position_drift.push_back(now.position.named(mechanism_));
  s.velocity_drift.push_back(now.velocity.named(mechanism_));
  if (mechanism_.has_lengths() && mechanism_.has_angles()) {
    s.angle_drift.push_back(now.position.angles);
    s.angle_rate_drift.push_back(now.velocity.angles);
  }
  s.energy.push_back(now.energy);
  s.energy_error.push_back(now.energy - energy_at_start_);
  s.impulse.push_back(now_.multipliers.norm());
}

/// The row of the trajectory, and errors. False: the run is to end.
bool RunMonitor::keep_row(double t, const Measured& now) {
  if (!request_.keep_trajectory && !request_.reference && !errors_.measures_own()) return true;
  row_.set(t, now_, *e_, now.energy, now.position, now.velocity);
  if (request_.keep_trajectory)
    row_.note_undetermined(t, result_.trajectory.columns.size(), result_.undetermined);
  errors_.sample(t, now_, row_, work_.until(t));
  if (!request_.keep_trajectory) return true;
  std::vector<double> kept = kept_row();
  if (request_.on_row && !request_.on_row(kept)) return false;
  if (rows_++ % request_.keep_every == 0) result_.trajectory.rows.push_back(std::move(kept));
  return true;
}

/// Reactions that only the reference asks for stand behind the trajectory's columns.
std::vector<double> RunMonitor::kept_row() const {
  std::vector<double> row = row_.numbers();
  row.resize(result_.trajectory.columns.size());
  return row;
}

void RunMonitor::keep_closed(double t, const Eigen::VectorXd& q) {
  constexpr double closed = 1e-5;  // lengths of the scene, or radians
  if (!mechanism_.plan().drives || apart_->gap(phi_) > closed) return;
  closed_.t = t;
  closed_.q = q;
}

void RunMonitor::carry(Memory& memory) {
  work_.carry(memory);
  if (singular_crossings_) singular_crossings_->carry(memory);
  if (written_) written_->carry(memory);
  memory(energy_at_start_), memory(potential_at_start_);
  departures_.carry(memory);
  memory(largest_between_.lengths), memory(largest_between_.angles), memory(fastest_);
  errors_.carry(memory), memory(rows_);
  limits_.carry(memory);
  if (events_) events_->carry(memory);
  bool closed = closed_.q.size() > 0;
  memory(closed);
  if (!closed) return;
  closed_.q.conservativeResize(mechanism_.nq());
  memory(closed_.t), memory(closed_.q.data(), static_cast<std::size_t>(closed_.q.size()));
}

void RunMonitor::finish() {
  const Series& s = result_.series;
  // NaN: not measured, as errors off the reference's times.
  const auto largest = [](const std::vector<double>& v) {
    double m = not_measured;
    for (double x : v)
      if (!std::isnan(x) && !(std::abs(x) <= m)) m = std::abs(x);
    return m;
  };
  if (singular_crossings_) singular_crossings_->finish();
  result_.energy_error_max = largest(s.energy_error);
  if (!s.t.empty()) result_.energy_turned_over = departures_.turned_over();
  departures_.judge(result_);
  if (singular_crossings_ && now_.q.size() > 0)  // empty: a continued run had no time left
    result_.last_pose = apart_->in_units(now_.q);
  result_.multiplier_difference_max = largest(s.multiplier_difference);
  result_.reaction_errors = errors_.of_reactions();
  if (request_.reference && result_.status == "done" && errors_.compared() > 0)
    for (const RunError& error : run_errors()) result_.*error.largest = largest(s.*error.series);
  if (mechanism_.m() == 0) return;
  const bool lengths = mechanism_.has_lengths();
  result_.position_drift_max = largest(s.position_drift);
  result_.velocity_drift_max = largest(s.velocity_drift);
  result_.between_steps_max = largest_between_.named(mechanism_);
  const auto growth = [&](const std::vector<double>& drift, double rounding) {
    return fit_growth(s.t, drift, std::max(rounding_level, rounding));
  };
  // The residue of redundant equations changes with the pose by about as much.
  const Drift left = drift_of(mechanism_, residue_);
  const double rounding = std::max(apart_->rounding(!lengths), 4 * left.named(mechanism_)),
               angles = std::max(apart_->rounding(true), 4 * left.angles);
  constexpr double of_steps = 10;  // times the rounding of one pose
  result_.drift_rounding = std::max(rounding_level, of_steps * rounding);
  result_.angle_rounding = std::max(rounding_level, of_steps * angles);
  result_.position_growth = growth(s.position_drift, rounding);
  result_.velocity_growth = growth(s.velocity_drift, rounding * fastest_);
  if (!lengths || !mechanism_.has_angles()) return;
  result_.angle_drift_max = largest(s.angle_drift);
  result_.angle_rate_drift_max = largest(s.angle_rate_drift);
  result_.angle_between_steps_max = largest_between_.angles;
  result_.angle_growth = growth(s.angle_drift, angles);
  result_.angle_rate_growth = growth(s.angle_rate_drift, angles * fastest_);
}

}  // namespace momenta
