#pragma once
// The run monitor: measures drift, energy, errors and faded rows along a run, at the output times
// and between the steps: those of the scene as written, whatever joints the run cuts. Only
// run_form.cpp uses it.

#include <momenta/dae/cut/integrated_scene.h>
#include <momenta/dae/cut/written_motion.h>
#include <momenta/dae/measure/growth.h>
#include <momenta/dae/measure/multipliers.h>
#include <momenta/dae/study/apart.h>
#include <momenta/dae/study/dissipated_energy.h>
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
             const Start& start, const RunRequest& request, RunResult& result)
      : mechanism_(mechanism),
        form_(form),
        request_(request),
        result_(result),
        e_(mechanism.evaluation<double>()),
        lengths_(mechanism.has_lengths()),
        both_(lengths_ && mechanism.has_angles()),
        residue_(start.residue),
        phi_(mechanism.m()),
        middle_(mechanism.nq()),
        markers_(static_cast<std::size_t>(6 * static_cast<int>(mechanism.scene().markers.size()))),
        dissipated_energy_(mechanism),
        limits_(mechanism) {
    if (request.keep_trajectory) result.trajectory.columns = trajectory_columns(mechanism);
    if (mechanism.m() > 0) {
      result.drift_unit = lengths_ ? "m" : "rad";
      apart_.emplace(mechanism, result.settings);
      solver_ = make_loop_solver(mechanism, *e_);
      unique_.emplace(mechanism, *e_, *solver_);
      all_unique_.assign(static_cast<std::size_t>(mechanism.m()), true);
    }
    const Mechanism& integrated = scene.mechanism();
    if (scene.anew()) {
      written_.emplace(mechanism, start, scene.folded(), integrated);
      of_form_.q.resize(integrated.nq());
      integrated_e_ = integrated.evaluation<double>();
      integrated_solver_ = make_loop_solver(integrated, *integrated_e_);
    }
    if (integrated.m() > 0 && (integrated.kkt() == KktChoice::sweeps || filters_pivots(integrated)))
      singular_crossings_.emplace(integrated, form, written_ ? *integrated_e_ : *e_,
                                  written_ ? *integrated_solver_ : *solver_, result);
  }

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
    const double energy = mechanism_.balances_energy()
                              ? kinetic + potential - dissipated_energy_.until(t)
                              : not_measured;
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
    const bool row_wanted = request_.keep_trajectory || request_.reference;
    if (row_wanted) row(t, energy, position, velocity);
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

  bool step(double t0, double t1, const Interpolant& between) {
    state_.resize(
        static_cast<std::size_t>(form_.is_dae() ? form_.dae()->size() : form_.ode()->size()));
    if (request_.film_intervals > 0) film_until(t1, between);
    const double middle = 0.5 * (t0 + t1);
    if (mechanism_.m() > 0) {
      between(middle, state_.data());
      if (!read_coordinates(middle)) return true;
      e_->place(middle, middle_.data());
      e_->positions(phi_.data());
      const Drift drift = drift_of(mechanism_, beyond_residue());
      if (!(drift.lengths <= between_.lengths)) between_.lengths = drift.lengths;
      if (!(drift.angles <= between_.angles)) between_.angles = drift.angles;
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
    if (dissipated_energy_.any() && !dissipated_energy_.step(t0, t1, [&](double t, double& watts) {
          between(t, state_.data());
          if (!read(t, state_.data(), nullptr)) return false;
          e_->place(t, now_.q.data());
          e_->move(now_.u.data());
          watts = e_->dissipated_power(now_.q.data(), now_.u.data());
          return true;
        }))
      return true;
    return !request_.going_on || request_.going_on();
  }

  /// Whether what is looked at does not depend on what was looked at before.
  bool can_be_put_down() const {
    return (!solver_ || !solver_->remembers()) &&
           (!integrated_solver_ || !integrated_solver_->remembers());
  }
  /// Between two steps; beside what is in the result.
  void carry(Memory& memory) {
    dissipated_energy_.carry(memory);
    if (singular_crossings_) singular_crossings_->carry(memory);
    if (written_) written_->carry(memory);
    memory(energy_at_start_), memory(potential_at_start_);
    memory(between_.lengths), memory(between_.angles), memory(fastest_);
    memory(compared_), memory(rows_);
    limits_.carry(memory);
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
      result_.between_steps_max = named(between_);
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
        result_.angle_between_steps_max = between_.angles;
        result_.angle_growth = growth(s.angle_drift, angles);
        result_.angle_rate_growth = growth(s.angle_rate_drift, angles * fastest_);
      }
    }
    if (request_.reference && result_.status == "done" && compared_ > 0) {
      result_.position_error_max = largest(s.position_error);
      result_.velocity_error_max = largest(s.velocity_error);
    }
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
    if (!form_.read(t, y, ydot, of_form)) return false;
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
    if (!form_.read_coordinates(t, state_.data(), of_form)) return false;
    if (written_) written_->read_coordinates(t, of_form, middle_);
    return true;
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
    if (mechanism_.m() == 0) return;
    row_.push_back(named(position));
    row_.push_back(named(velocity));
    if (both_) row_.insert(row_.end(), {position.angles, velocity.angles});
    if (request_.keep_trajectory) {
      Eigen::VectorXd udot(mechanism_.nv()), lambda(mechanism_.m());
      if (!solver_->acceleration(t, now_.q.data(), now_.u.data(), nullptr, 0, 0, udot.data(),
                                 lambda.data()))
        lambda.setConstant(not_measured);
      loop_forces(t, lambda);
    }
  }

  /// λ of each loop, and how many of them are not unique.
  void loop_forces(double t, const Eigen::VectorXd& lambda) {
    const bool found = !std::isnan(lambda[0]);
    const std::vector<bool>& unique =
        found ? unique_->find(t, now_.q.data(), now_.u.data(), lambda.data()) : all_unique_;
    const auto& rows = mechanism_.rows();
    int not_unique = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!unique[i]) note_undetermined(row_.size(), t);
      row_.push_back(lambda[static_cast<Eigen::Index>(i)]);
      not_unique += !unique[i];
      if (i + 1 < rows.size() && rows[i + 1].loop == rows[i].loop) continue;
      row_.push_back(found ? not_unique : not_measured);
      not_unique = 0;
    }
  }
  void note_undetermined(std::size_t column, double t) {
    const std::string& label = result_.trajectory.columns[column];
    auto& all = result_.undetermined;
    auto at =
        std::find_if(all.begin(), all.end(), [&](const auto& u) { return u.column == label; });
    if (at == all.end()) at = all.insert(at, {label, 0, t, t});
    ++at->samples;
    at->to = t;
  }

  void compare(double t) {
    const auto& times = request_.reference->times();
    const double apart = 1e-9 * result_.settings.end_time;
    const auto at = std::lower_bound(times.begin(), times.end(), t - apart);
    const bool hit = at != times.end() && *at <= t + apart;
    Series& s = result_.series;
    s.position_error.push_back(not_measured);
    s.velocity_error.push_back(not_measured);
    if (!hit) return;
    const auto error =
        request_.reference->error(static_cast<std::size_t>(at - times.begin()), row_);
    s.position_error.back() = error.position;
    s.velocity_error.back() = error.velocity;
    ++compared_;
  }

  const Mechanism& mechanism_;
  Form& form_;
  const RunRequest& request_;
  RunResult& result_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;
  std::optional<WrittenMotion> written_;  ///< where the run integrates another scene
  std::unique_ptr<Evaluation<double>> integrated_e_;
  std::unique_ptr<LoopSolver> integrated_solver_;
  Snapshot of_form_;  ///< of the integrated scene
  std::optional<UniqueMultipliers> unique_;
  std::vector<bool> all_unique_;
  bool lengths_, both_;      ///< rows in m; and others in rad
  Eigen::VectorXd residue_;  ///< Φ at the start where redundant equations leave it open, or empty
  Eigen::VectorXd phi_, drift_, middle_;
  std::vector<double> markers_, row_, state_;
  Snapshot now_;
  DissipatedEnergy dissipated_energy_;
  PassedLimits limits_;
  std::optional<SingularCrossings> singular_crossings_;
  std::optional<Apart> apart_;
  std::string came_apart_;
  Closed closed_;
  double energy_at_start_ = 0, potential_at_start_ = 0;
  Drift between_;
  double fastest_ = 0;  ///< rate of a joint at the samples, in lengths of the scene [1/s]
  int compared_ = 0;
  long rows_ = 0;  ///< of the trajectory
  std::string trouble_;
};

}  // namespace momenta
