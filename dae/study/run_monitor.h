#pragma once
// The run monitor: measures drift, energy, errors and faded rows along a run, at the output times
// and between the steps, and finds events: those of the scene as written, whatever joints the run
// cuts. Only run_form.cpp uses it.

#include <momenta/dae/cut/integrated_scene.h>
#include <momenta/dae/cut/written_motion.h>
#include <momenta/dae/measure/drive_power.h>
#include <momenta/dae/measure/growth.h>
#include <momenta/dae/study/apart.h>
#include <momenta/dae/study/event_watch.h>
#include <momenta/dae/study/force_columns.h>
#include <momenta/dae/study/integrated_work.h>
#include <momenta/dae/study/own_multipliers.h>
#include <momenta/dae/study/passed_limits.h>
#include <momenta/dae/study/run_form.h>
#include <momenta/dae/study/singular_crossings.h>

#include <algorithm>
#include <optional>

namespace momenta {

/// |x|₂ of rows in m, and of rows in rad.
struct Drift {
  double lengths = 0, angles = 0;
  bool finite() const { return std::isfinite(lengths) && std::isfinite(angles); }
};
inline Drift drift_of(const Mechanism& mechanism, const Eigen::VectorXd& x) {
  if (!mechanism.has_angles()) return {x.norm(), 0};
  if (!mechanism.has_lengths()) return {0, x.norm()};
  Drift sum;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    (mechanism.angle_rows()[static_cast<std::size_t>(i)] ? sum.angles : sum.lengths) += x[i] * x[i];
  return {std::sqrt(sum.lengths), std::sqrt(sum.angles)};
}

/// Looks at states of a form: drifts, energy, errors.
class RunMonitor {
 public:
  RunMonitor(const Mechanism& mechanism, const IntegratedScene& scene, Form& form,
             const Start& start, const RunRequest& request, RunResult& result, RigidStops* stops)
      : mechanism_(mechanism),
        form_(&form),
        request_(request),
        result_(result),
        e_(mechanism.evaluation<double>()),
        lengths_(mechanism.has_lengths()),
        both_(lengths_ && mechanism.has_angles()),
        residue_(start.residue),
        phi_(mechanism.m()),
        middle_(mechanism.nq()),
        markers_(static_cast<std::size_t>(6 * static_cast<int>(mechanism.scene().markers.size()))),
        columns_(trajectory_columns(mechanism, request.reactions)),
        works_(IntegratedWork::has_any(mechanism)),
        limits_(mechanism) {
    if (request.keep_trajectory) result.trajectory.columns = columns_;
    if (mechanism.m() > 0) {
      result.drift_unit = lengths_ ? "m" : "rad";
      apart_.emplace(mechanism, result.settings);
      solver_ = make_loop_solver(mechanism, *e_);
    }
    drives_.emplace(mechanism, *e_, solver_.get());
    const bool compares_forces = request.reference && request.reference->has_forces();
    if (request.keep_trajectory || compares_forces || request.multipliers)
      forces_.emplace(mechanism, *e_, solver_.get(), request.reactions);
    const Mechanism& integrated = scene.mechanism();
    if (scene.anew()) {
      written_.emplace(mechanism, start, scene.folded(), integrated);
      of_form_.q.resize(integrated.nq());
      integrated_e_ = integrated.evaluation<double>();
      integrated_solver_ = make_loop_solver(integrated, *integrated_e_);
    } else if (mechanism.m() > 0 && !stops && (compares_forces || request.multipliers)) {
      own_.emplace(form, mechanism.m());
    }
    if (integrated.m() > 0 && !stops &&
        (integrated.kkt() == KktChoice::sweeps || filters_pivots(integrated)))
      singular_crossings_.emplace(integrated, form, written_ ? *integrated_e_ : *e_,
                                  written_ ? *integrated_solver_ : *solver_, result);
    const bool looks = request.events && !mechanism.scene().events.empty();
    stops_ = stops;
    if (looks || stops)
      events_.emplace(
          mechanism, looks ? mechanism.scene().events : std::vector<EventSpec>{},
          result.settings.end_time - start.t,
          [this](double t, bool exact, bool rates, const Eigen::VectorXd*& q,
                 const Eigen::VectorXd*& u) { return read_at(t, exact, rates, q, u); },
          stops);
    if (stops) go_on(start.t, form);
  }

  /// The next phase of a run with rigid stops: `form` is of what acts from now on, whose forces and
  /// power are measured. @pre there are stops
  void go_on(double t, Form& form) {
    form_ = &form;
    exact_ = nullptr;
    const Mechanism& acting = stops_->acting();
    acting_e_ = acting.evaluation<double>();
    acting_solver_ = acting.m() > 0 ? make_loop_solver(acting, *acting_e_) : nullptr;
    drives_.emplace(acting, *acting_e_, acting_solver_.get());
    if (forces_) {
      forces_.emplace(acting, *acting_e_, acting_solver_.get(), request_.reactions);
      force_places_.clear();
      if (&acting != &mechanism_) {
        const std::vector<std::string> all = trajectory_columns(acting, request_.reactions);
        const std::size_t drifts = acting.m() == 0                               ? 0
                                   : acting.has_lengths() && acting.has_angles() ? 4
                                                                                 : 2;
        const std::size_t own = mechanism_.m() == 0 ? 0 : both_ ? 4 : 2;
        const std::size_t state =
            static_cast<std::size_t>(mechanism_.nq() + mechanism_.nv()) + markers_.size() + 2;
        for (std::size_t c = state + own; c < columns_.size(); ++c) {
          const auto at = std::find(all.begin() + static_cast<std::ptrdiff_t>(state + drifts),
                                    all.end(), columns_[c]);
          force_places_.push_back(static_cast<std::size_t>(at - all.begin()) - state - drifts);
        }
      }
    }
    hit_.reset();
    events_->restart(t);
  }

  /// Where a rigid stop was met, or one that held is to let go; and which.
  struct Hit {
    double t = 0;
    Eigen::VectorXd q, u;
    std::vector<std::size_t> stops;
  };
  const std::optional<Hit>& hit() const { return hit_; }
  /// Energy that stops took at an impact [J].
  void take_energy(double taken) { work_.add(-taken); }

  /// Another output of the last step, of full order.
  void take_exact(const Interpolant& exact) {
    exact_ = exact;
    if (events_) events_->has_exact();
  }

  /// The times at which samples will be asked for; they must outlive this.
  void expect_samples_at(const std::vector<double>& times) { output_times_ = &times; }

  bool sample(double t, const double* y, const double* ydot) {
    if (!read(t, y, ydot)) {
      trouble_ = "at t = " + std::to_string(t) + " s the velocities cannot be read back";
      return false;
    }
    e_->place(t, now_.q.data());
    e_->positions(phi_.data());
    const Drift position = drift_of(mechanism_, beyond_residue());
    if (apart_) fastest_ = std::max(fastest_, apart_->speed(now_.u));
    if (apart_ && position.finite()) {
      came_apart_ = apart_->found(t, phi_, true);
      keep_closed(t, now_.q);
    }
    e_->move(now_.u.data());
    e_->velocities(phi_.data());
    const Drift velocity = drift_of(mechanism_, phi_);
    const double kinetic = e_->kinetic(), potential = e_->potential(now_.q.data());
    const double energy = kinetic + potential - work_.until(t);
    if (!position.finite() || !velocity.finite()) {
      trouble_ = "at t = " + std::to_string(t) + " s the state is not finite";
      return false;
    }
    Series& s = result_.series;
    if (s.t.empty()) {
      limits_.look(t, now_.q.data(), result_.passed_limits);
      energy_at_start_ = energy;
      potential_at_start_ = potential;
    }
    const double exchanged = kinetic + std::abs(potential - potential_at_start_);
    if (!(kinetic <= result_.kinetic_energy_max)) result_.kinetic_energy_max = kinetic;
    if (!(exchanged <= result_.energy_scale)) result_.energy_scale = exchanged;
    s.t.push_back(t);
    s.position_drift.push_back(named(position));
    s.velocity_drift.push_back(named(velocity));
    if (both_) {
      s.angle_drift.push_back(position.angles);
      s.angle_rate_drift.push_back(velocity.angles);
    }
    s.energy.push_back(energy);
    s.energy_error.push_back(energy - energy_at_start_);
    s.impulse.push_back(now_.multipliers.norm());
    if (request_.keep_trajectory || request_.reference || own_) {
      row(t, energy, position, velocity);
      if (request_.keep_trajectory && forces_)
        for (const std::size_t column : not_unique_) note_undetermined(column, t);
    }
    if (own_) compare_own(t);
    if (request_.reference) compare(t);
    if (request_.keep_trajectory) {
      if (request_.on_row && !request_.on_row(row_)) return false;
      if (rows_++ % request_.keep_every == 0) result_.trajectory.rows.push_back(row_);
    }
    if (request_.film_intervals > 0 && result_.film.frames.empty()) {
      result_.film.start = t;
      result_.film.every = (result_.settings.end_time - t) / request_.film_intervals;
      result_.film.frames.emplace_back(now_.q.begin(), now_.q.end());
    }
    if (!came_apart_.empty()) return false;
    return !request_.progress || request_.progress(t);
  }

  /// Looks at the step that was just taken, up to the event that ends the run.
  bool step(double t0, double t1, const Interpolant& between) {
    state_.resize(
        static_cast<std::size_t>(form_->is_dae() ? form_->dae()->size() : form_->ode()->size()));
    if (!events_) return look_between(t0, t1, between, false);
    between_ = &between;
    const std::vector<EventWatch::Found>& found = events_->step(t0, t1, result_.event_remarks);
    const bool ends = !found.empty() && events_->ends(found.back());
    const double until = ends ? found.back().crossing.t : t1;
    if (!look_between(t0, until, between, !found.empty())) return false;
    for (const EventWatch::Found& f : found)
      if (!events_->is_stop(f))
        result_.events.push_back(
            {events_->name(f.event), f.crossing.t, f.crossing.up, row_at(f.crossing.t)});
    return !ends ||
           (events_->is_stop(found.back()) ? meet(until, found) : end_at(until, found.back()));
  }
  /// The event that ended the run, in words; empty: none did.
  const std::string& ended_by() const { return ended_by_; }
  double ended_at() const { return ended_at_; }  ///< [s]

 private:
  /// `inside`: the energy at times inside the step will be asked for.
  bool look_between(double t0, double t1, const Interpolant& between, bool inside) {
    if (request_.film_intervals > 0) film_until(t1, between);
    const double middle = 0.5 * (t0 + t1);
    if (mechanism_.m() > 0) {
      between(middle, state_.data());
      if (!read_coordinates(middle)) return true;
      e_->place(middle, middle_.data());
      e_->positions(phi_.data());
      const Drift drift = drift_of(mechanism_, beyond_residue());
      if (!(drift.lengths <= largest_between_.lengths)) largest_between_.lengths = drift.lengths;
      if (!(drift.angles <= largest_between_.angles)) largest_between_.angles = drift.angles;
      if (drift.finite()) came_apart_ = apart_->found(middle, phi_, false);
      if (!came_apart_.empty()) return false;
      keep_closed(middle, middle_);
    }
    if (singular_crossings_) singular_crossings_->step(t0, t1, between, state_);
    if (limits_.any())
      limits_.step(
          t1,
          [&](double t) -> const double* {
            between(t, state_.data());
            return read_coordinates(t) ? middle_.data() : nullptr;
          },
          result_.passed_limits);
    if (own_ && sample_before(t1 * (1 + 1e-12))) own_->step(t0, t1, between, state_);
    if ((works_ || drives_->any()) &&
        !work_.step(t0, t1, inside || sample_before(t1 * (1 - 1e-12)),
                    [&](double t, double& watts) {
                      between(t, state_.data());
                      if (!read(t, state_.data(), nullptr)) return false;
                      watts = 0;
                      if (works_) {
                        e_->place(t, now_.q.data());
                        e_->move(now_.u.data());
                        watts = e_->dissipated_power(now_.q.data(), now_.u.data());
                      }
                      if (drives_->any()) watts += drives_->at(t, now_.q.data(), now_.u.data());
                      return true;
                    }))
      return true;
    return !request_.going_on || request_.going_on();
  }

 public:
  /// Whether what is looked at does not depend on what was looked at before.
  bool can_be_put_down() const {
    return !stops_ && (!solver_ || !solver_->remembers()) &&
           (!integrated_solver_ || !integrated_solver_->remembers());
  }
  /// Between two steps; beside what is in the result.
  void carry(Memory& memory) {
    work_.carry(memory);
    if (singular_crossings_) singular_crossings_->carry(memory);
    if (written_) written_->carry(memory);
    memory(energy_at_start_), memory(potential_at_start_);
    memory(largest_between_.lengths), memory(largest_between_.angles), memory(fastest_);
    memory(compared_), memory(rows_);
    limits_.carry(memory);
    if (events_) events_->carry(memory);
    bool closed = closed_.q.size() > 0;
    memory(closed);
    if (!closed) return;
    closed_.q.conservativeResize(mechanism_.nq());
    memory(closed_.t), memory(closed_.q.data(), static_cast<std::size_t>(closed_.q.size()));
  }

  void finish() {
    const Series& s = result_.series;
    // Of what was measured: errors are, at the reference's times alone.
    const auto largest = [](const std::vector<double>& v) {
      double m = not_measured;
      for (double x : v)
        if (!std::isnan(x) && !(std::abs(x) <= m)) m = std::abs(x);
      return m;
    };
    if (singular_crossings_) singular_crossings_->finish();
    result_.energy_error_max = largest(s.energy_error);
    if (mechanism_.m() > 0) {
      result_.position_drift_max = largest(s.position_drift);
      result_.velocity_drift_max = largest(s.velocity_drift);
      result_.between_steps_max = named(largest_between_);
      const auto growth = [&](const std::vector<double>& drift, double rounding) {
        return fit_growth(s.t, drift, std::max(rounding_level, rounding));
      };
      // What redundant equations leave open changes with the pose by about as much.
      const Drift left = drift_of(mechanism_, residue_);
      const double rounding = std::max(apart_->rounding(!lengths_), 4 * named(left)),
                   angles = std::max(apart_->rounding(true), 4 * left.angles);
      result_.position_growth = growth(s.position_drift, rounding);
      result_.velocity_growth = growth(s.velocity_drift, rounding * fastest_);
      if (both_) {
        result_.angle_drift_max = largest(s.angle_drift);
        result_.angle_rate_drift_max = largest(s.angle_rate_drift);
        result_.angle_between_steps_max = largest_between_.angles;
        result_.angle_growth = growth(s.angle_drift, angles);
        result_.angle_rate_growth = growth(s.angle_rate_drift, angles * fastest_);
      }
    }
    if (request_.reference && result_.status == "done" && compared_ > 0) {
      result_.position_error_max = largest(s.position_error);
      result_.velocity_error_max = largest(s.velocity_error);
      result_.force_error_max = largest(s.force_error);
      result_.multiplier_error_max = largest(s.multiplier_error);
    }
    result_.multiplier_difference_max = largest(s.multiplier_difference);
  }

  const std::string& trouble() const { return trouble_; }
  /// One sentence where the loops have come apart; empty where they have not.
  const std::string& came_apart() const { return came_apart_; }
  /// The last state with loops closed, of mechanisms with drives and loops.
  struct Closed {
    double t = 0;
    Eigen::VectorXd q;
  };
  const Closed& last_closed() const { return closed_; }

 private:
  /// The state as `now_`, with unit quaternions: interpolants leave them off by the tolerance.
  bool read(double t, const double* y, const double* ydot) {
    Snapshot& of_form = written_ ? of_form_ : now_;
    if (!form_->read(t, y, ydot, of_form)) return false;
    if (written_) {
      written_->read(t, of_form.q, of_form.u, now_.q, now_.u);
      now_.multipliers = of_form.multipliers;
    }
    mechanism_.tree().normalise(now_.q);
    return true;
  }
  /// The coordinates alone, of `state_`, as `middle_`.
  bool read_coordinates(double t) {
    Eigen::VectorXd& of_form = written_ ? of_form_.q : middle_;
    if (!form_->read_coordinates(t, state_.data(), of_form)) return false;
    if (written_) written_->read_coordinates(t, of_form, middle_);
    return true;
  }
  /// A state inside the last step, for events: `u` null where rates are not asked for.
  bool read_at(double t, bool exact, bool rates, const Eigen::VectorXd*& q,
               const Eigen::VectorXd*& u) {
    (exact ? exact_ : *between_)(t, state_.data());
    if (!rates) {
      if (!read_coordinates(t)) return false;
      mechanism_.tree().normalise(middle_);
      q = &middle_;
      return true;
    }
    if (!read(t, state_.data(), nullptr)) return false;
    q = &now_.q;
    u = &now_.u;
    return true;
  }
  /// The state at an event, as `state_`.
  void take_state_at(double t) { (exact_ ? exact_ : *between_)(t, state_.data()); }
  /// The row of the trajectory at an event; empty where none is kept or it cannot be read.
  std::vector<double> row_at(double t) {
    take_state_at(t);
    if (!request_.keep_trajectory || !read(t, state_.data(), nullptr)) return {};
    e_->place(t, now_.q.data());
    e_->positions(phi_.data());
    const Drift position = drift_of(mechanism_, beyond_residue());
    e_->move(now_.u.data());
    e_->velocities(phi_.data());
    const double energy = e_->kinetic() + e_->potential(now_.q.data()) - work_.until(t);
    row(t, energy, position, drift_of(mechanism_, phi_));
    return row_;
  }
  /// The samples up to t, inside the last step. False: the run is to end.
  bool sample_until(double t) {
    while (sample_before(t)) {
      const double at = (*output_times_)[next_];
      take_state_at(at);
      if (!sample(at, state_.data(), nullptr)) return false;
    }
    return true;
  }
  /// The samples up to stops that are met, and the state there. @return false
  bool meet(double t, const std::vector<EventWatch::Found>& found) {
    if (!sample_until(t)) return false;
    take_state_at(t);
    if (!read(t, state_.data(), nullptr)) return false;
    hit_ = Hit{t, now_.q, now_.u, {}};
    for (const EventWatch::Found& f : found)
      if (events_->is_stop(f)) hit_->stops.push_back(f.event - events_->first_stop());
    return false;
  }
  /// The samples up to the event that ends the run, and one there. @return false
  bool end_at(double t, const EventWatch::Found& event) {
    // An output time this near is the event.
    const double near = 1e-9 * result_.settings.end_time / result_.settings.samples;
    if (!sample_until(t - near)) return false;
    take_state_at(t);
    if (result_.series.t.back() < t - near && !sample(t, state_.data(), nullptr)) return false;
    ended_at_ = t;
    ended_by_ = "event '" + events_->name(event.event) + "' (" +
                (event.crossing.up ? "up" : "down") + ") ended the run at t = " + compact(t, 8) +
                " s";
    return false;
  }
  /// Φ less what the start leaves open.
  const Eigen::VectorXd& beyond_residue() {
    if (residue_.size() == 0) return phi_;
    drift_ = phi_ - residue_;
    return drift_;
  }
  /// @pre phi_ is Φ at (t, q)
  void keep_closed(double t, const Eigen::VectorXd& q) {
    constexpr double closed = 1e-5;  // of the scene's length, or radians
    if (!mechanism_.plan().drives || apart_->gap(phi_) > closed) return;
    closed_.t = t;
    closed_.q = q;
  }
  /// Coordinates at the film's times within the last step.
  void film_until(double t1, const Interpolant& between) {
    Film& film = result_.film;
    const double rounding = 1e-9 * film.every;
    while (static_cast<int>(film.frames.size()) <= request_.film_intervals) {
      const double t = film.start + film.every * static_cast<double>(film.frames.size());
      if (t > t1 + rounding) return;
      between(std::min(t, t1), state_.data());
      if (!read_coordinates(t)) return;
      mechanism_.tree().normalise(middle_);
      film.frames.emplace_back(middle_.begin(), middle_.end());
    }
  }
  /// What is called the position or the velocity drift: of lengths, where there are any.
  double named(const Drift& drift) const { return lengths_ ? drift.lengths : drift.angles; }

  void row(double t, double energy, const Drift& position, const Drift& velocity) {
    row_.clear();
    row_.push_back(t);
    row_.insert(row_.end(), now_.q.begin(), now_.q.end());
    row_.insert(row_.end(), now_.u.begin(), now_.u.end());
    e_->markers(markers_.data());
    row_.insert(row_.end(), markers_.begin(), markers_.end());
    row_.push_back(energy);
    if (mechanism_.m() > 0) {
      row_.push_back(named(position));
      row_.push_back(named(velocity));
      if (both_) row_.insert(row_.end(), {position.angles, velocity.angles});
    }
    if (!forces_) return;
    first_force_ = row_.size();
    not_unique_.clear();
    not_unique_acting_.clear();
    forces_->solve(t, now_.q, now_.u);
    if (force_places_.empty()) return forces_->append(row_, not_unique_);
    // Of what acts, beside whose loops there are those of stops that hold.
    acting_row_.clear();
    forces_->append(acting_row_, not_unique_acting_);
    for (std::size_t k = 0; k < force_places_.size(); ++k)
      row_.push_back(acting_row_[force_places_[k]]);
    for (std::size_t k = 0; k < force_places_.size(); ++k)
      if (std::find(not_unique_acting_.begin(), not_unique_acting_.end(), force_places_[k]) !=
          not_unique_acting_.end())
        not_unique_.push_back(first_force_ + k);
  }

  void note_undetermined(std::size_t column, double t) {
    const std::string& label = columns_[column];
    auto& all = result_.undetermined;
    auto at =
        std::find_if(all.begin(), all.end(), [&](const auto& u) { return u.column == label; });
    if (at == all.end()) at = all.insert(at, {label, 0, t, t});
    ++at->samples;
    at->to = t;
  }

  /// Whether an output time that is still to come lies before t or at it.
  bool sample_before(double t) {
    const std::vector<double>& times = *output_times_;
    const std::vector<double>& seen = result_.series.t;
    while (next_ < times.size() && !seen.empty() && times[next_] <= seen.back()) ++next_;
    return next_ < times.size() && times[next_] <= t;
  }

  /// The form's own λ against that of (3), and, in its place, against the reference.
  void compare_own(double t) {
    Series& s = result_.series;
    s.multiplier_difference.push_back(not_measured);
    const Eigen::VectorXd& own = own_->at(t, now_.multipliers);
    own_row_.clear();
    if (own.size() == 0) return;
    own_row_ = row_;
    std::size_t column = first_force_;
    double& difference = s.multiplier_difference.back();
    for (Eigen::Index i = 0; i < own.size(); ++i, ++column) {
      if (i > 0 && new_loop(i)) ++column;  // over `undetermined`
      own_row_[column] = own[i];
      const double solved = forces_->lambda()[i],
                   apart = std::abs(own[i] - solved) / (1 + std::abs(solved));
      if (forces_->unique()[static_cast<std::size_t>(i)] && !(apart <= difference))
        difference = apart;
    }
  }
  bool new_loop(Eigen::Index i) const {
    const auto at = static_cast<std::size_t>(i);
    return mechanism_.rows()[at].loop != mechanism_.rows()[at - 1].loop;
  }

  void compare(double t) {
    const auto& times = request_.reference->times();
    const double apart = 1e-9 * result_.settings.end_time;
    const auto at = std::lower_bound(times.begin(), times.end(), t - apart);
    const bool hit = at != times.end() && *at <= t + apart;
    Series& s = result_.series;
    s.position_error.push_back(not_measured);
    s.velocity_error.push_back(not_measured);
    const bool with_forces = request_.reference->has_forces();
    if (with_forces) s.force_error.push_back(not_measured);
    if (with_forces && own_) s.multiplier_error.push_back(not_measured);
    if (!hit) return;
    const auto row_of_reference = static_cast<std::size_t>(at - times.begin());
    const auto error = request_.reference->error(row_of_reference, row_, not_unique_);
    s.position_error.back() = error.position;
    s.velocity_error.back() = error.velocity;
    ++compared_;
    if (with_forces) s.force_error.back() = error.force;
    if (with_forces && own_ && !own_row_.empty())
      s.multiplier_error.back() =
          request_.reference->error(row_of_reference, own_row_, not_unique_).force;
  }

  const Mechanism& mechanism_;
  Form* form_;
  const RunRequest& request_;
  RunResult& result_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;
  std::optional<WrittenMotion> written_;  ///< where the run integrates another scene
  std::unique_ptr<Evaluation<double>> integrated_e_;
  std::unique_ptr<LoopSolver> integrated_solver_;
  Snapshot of_form_;  ///< of the integrated scene
  std::optional<DrivePower> drives_;
  std::optional<ForceColumns> forces_;
  std::optional<OwnMultipliers> own_;  ///< where the run integrates the scene as written
  const std::vector<double>* output_times_ = nullptr;
  std::size_t next_ = 0;         ///< of the output times that are left
  std::size_t first_force_ = 0;  ///< column
  std::vector<std::size_t> not_unique_;
  std::vector<double> own_row_;
  bool lengths_, both_;      ///< rows in m; and others in rad
  Eigen::VectorXd residue_;  ///< Φ at the start where redundant equations leave it open, or empty
  Eigen::VectorXd phi_, drift_, middle_;
  std::vector<double> markers_, row_, state_;
  Snapshot now_;
  std::vector<std::string> columns_;  ///< of a trajectory
  bool works_;                        ///< beside drives, what has no potential
  IntegratedWork work_;
  PassedLimits limits_;
  std::optional<EventWatch> events_;
  RigidStops* stops_ = nullptr;  ///< null: there are none
  std::optional<Hit> hit_;
  std::unique_ptr<Evaluation<double>> acting_e_;  ///< of runs with rigid stops
  std::unique_ptr<LoopSolver> acting_solver_;
  std::vector<std::size_t> force_places_;  ///< of the columns among those of what acts
  std::vector<std::size_t> not_unique_acting_;
  std::vector<double> acting_row_;
  const Interpolant* between_ = nullptr;  ///< of the last step, while it is looked at
  Interpolant exact_;
  std::string ended_by_;
  double ended_at_ = 0;
  std::optional<SingularCrossings> singular_crossings_;
  std::optional<Apart> apart_;
  std::string came_apart_;
  Closed closed_;
  double energy_at_start_ = 0, potential_at_start_ = 0;
  Drift largest_between_;
  double fastest_ = 0;  ///< rate of a joint at the samples, in lengths of the scene [1/s]
  int compared_ = 0;
  long rows_ = 0;  ///< of the trajectory
  std::string trouble_;
};

}  // namespace momenta
