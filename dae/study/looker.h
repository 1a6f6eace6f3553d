#pragma once
// What is measured along a run: drift, energy, errors, rows that fade, at the output times and, by
// Gauss points, between the steps. Of run_form.cpp alone.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/measure/growth.h>
#include <momenta/dae/measure/multipliers.h>
#include <momenta/dae/study/run_form.h>

#include <algorithm>
#include <array>
#include <optional>

namespace momenta {

/// Looks at states of a form: drifts, energy, errors.
class Looker {
 public:
  Looker(const Mechanism& mechanism, Form& form, const RunRequest& request, RunResult& result)
      : mechanism_(mechanism),
        form_(form),
        request_(request),
        result_(result),
        e_(mechanism.evaluation<double>()),
        phi_(mechanism.m()),
        middle_(mechanism.nq()),
        markers_(static_cast<std::size_t>(6 * static_cast<int>(mechanism.scene().markers.size()))),
        loses_energy_(loses_energy(mechanism.scene())) {
    if (request.keep_trajectory) result.trajectory.columns = trajectory_columns(mechanism);
    if (mechanism.m() > 0) {
      solver_ = make_loop_solver(mechanism, *e_);
      unique_.emplace(mechanism, *e_, *solver_);
      all_unique_.assign(static_cast<std::size_t>(mechanism.m()), true);
    }
    length_ = length_of(mechanism.scene());
  }

  bool sample(double t, const double* y, const double* ydot) {
    if (!form_.read(t, y, ydot, now_)) {
      trouble_ = "at t = " + std::to_string(t) + " s the velocities cannot be read back";
      return false;
    }
    e_->place(t, now_.q.data());
    e_->positions(phi_.data());
    const double position = phi_.norm();
    e_->move(now_.u.data());
    e_->velocities(phi_.data());
    const double velocity = phi_.norm();
    const double kinetic = e_->kinetic(), potential = e_->potential(now_.q.data());
    const double energy =
        mechanism_.plan().drives ? not_measured : kinetic + potential - work_until(t);
    if (!std::isfinite(position) || !std::isfinite(velocity)) {
      trouble_ = "at t = " + std::to_string(t) + " s the state is not finite";
      return false;
    }
    Series& s = result_.series;
    if (s.t.empty()) {
      energy_at_start_ = energy;
      potential_at_start_ = potential;
    }
    const double exchanged = kinetic + std::abs(potential - potential_at_start_);
    if (!(kinetic <= result_.kinetic_energy_max)) result_.kinetic_energy_max = kinetic;
    if (!(exchanged <= result_.energy_scale)) result_.energy_scale = exchanged;
    s.t.push_back(t);
    s.position_drift.push_back(position);
    s.velocity_drift.push_back(velocity);
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
    return !request_.progress || request_.progress(t);
  }

  bool step(double t0, double t1, const Interpolant& between) {
    state_.resize(
        static_cast<std::size_t>(form_.is_dae() ? form_.dae()->size() : form_.ode()->size()));
    if (request_.film_intervals > 0) film_until(t1, between);
    const double middle = 0.5 * (t0 + t1);
    if (mechanism_.m() > 0) {
      between(middle, state_.data());
      if (!form_.read_coordinates(middle, state_.data(), middle_)) return true;
      e_->place(middle, middle_.data());
      e_->positions(phi_.data());
      const double drift = phi_.norm();
      if (!(drift <= between_)) between_ = drift;
    }
    if (solver_ && (mechanism_.kkt() == KktChoice::sweeps || filters_pivots(mechanism_)))
      look_for_passages(t0, t1, between);
    if (loses_energy_) {
      // Power at the Gauss points of the step; the polynomial through them gives the work up to any
      // sample inside it.
      work_ = work_until(step_end_);
      step_from_ = t0;
      step_end_ = t1;
      for (std::size_t i = 0; i < gauss_points.size(); ++i) {
        const double t = t0 + gauss_points[i] * (t1 - t0);
        between(t, state_.data());
        if (!form_.read(t, state_.data(), nullptr, now_)) return true;
        e_->place(t, now_.q.data());
        e_->move(now_.u.data());
        power_[i] = e_->lost_power(now_.u.data());
      }
    }
    return !request_.going_on || request_.going_on();
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
    result_.energy_error_max = largest(s.energy_error);
    if (mechanism_.m() > 0) {
      result_.position_drift_max = largest(s.position_drift);
      result_.velocity_drift_max = largest(s.velocity_drift);
      result_.between_steps_max = between_;
      // What stays at rounding level has no growth law.
      if (result_.position_drift_max > rounding_level)
        result_.position_growth = fit_growth(s.t, s.position_drift);
      if (result_.velocity_drift_max > rounding_level)
        result_.velocity_growth = fit_growth(s.t, s.velocity_drift);
    }
    if (request_.reference && result_.status == "done" && compared_ > 0) {
      result_.position_error_max = largest(s.position_error);
      result_.velocity_error_max = largest(s.velocity_error);
    }
  }

  const std::string& trouble() const { return trouble_; }

 private:
  static constexpr double rounding_level = 1e-13;  ///< of |Φ| and |Φ̇| in metres and seconds
  // Five-point Gauss rule on [0, 1].
  static constexpr std::array<double, 5> gauss_points{
      0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155, 0.95308992296933200};
  static constexpr std::array<double, 5> gauss_weights{0.11846344252809454, 0.23931433524968324,
                                                       0.28444444444444444, 0.23931433524968324,
                                                       0.11846344252809454};
  /// Coordinates at the film's times within the last step.
  void film_until(double t1, const Interpolant& between) {
    Film& film = result_.film;
    const double rounding = 1e-9 * film.every;
    while (static_cast<int>(film.frames.size()) <= request_.film_intervals) {
      const double t = film.start + film.every * static_cast<double>(film.frames.size());
      if (t > t1 + rounding) return;
      between(std::min(t, t1), state_.data());
      if (!form_.read_coordinates(t, state_.data(), middle_)) return;
      film.frames.emplace_back(middle_.begin(), middle_.end());
    }
  }
  /// The weakest pivot of the loops at a time within the last step; 0 where a row faded that is not
  /// redundant throughout.
  double pivot_at(double t, const Interpolant& between) {
    between(t, state_.data());
    if (!form_.read_coordinates(t, state_.data(), middle_)) return not_measured;
    at_rest_.setZero(mechanism_.nv());
    if (!solver_->free_velocity(t, middle_.data(), at_rest_.data(), unused_.data()))
      return not_measured;
    const LoopSolver::Pivots pivots = solver_->pivots();
    always_faded_ = std::min(always_faded_, pivots.faded);
    return pivots.faded > always_faded_ ? 0 : pivots.weakest;
  }
  /// Two motions that meet where a pivot vanishes with the square of the distance, Φ = x y = 0,
  /// keep clear of each other off the constraints, Φ = x y = η: no nearer than √η, where the pivot
  /// is about η, and there either leads into the other.
  bool is_ambiguous(double t, double pivot, const Interpolant& between) {
    constexpr double apart = 10;
    Snapshot here;
    between(t, state_.data());
    if (!form_.read(t, state_.data(), nullptr, here)) return false;
    e_->place(t, here.q.data());
    e_->positions(phi_.data());
    return phi_.norm() / length_ > rounding_level && pivot < apart * phi_.norm() / length_;
  }
  /// Least pivots below `near_singular`, one for each time the run goes there.
  void look_for_passages(double t0, double t1, const Interpolant& between) {
    constexpr double near_singular = 1e-2;
    constexpr int closer_looks = 8;
    unused_.resize(mechanism_.nv());
    const auto note = [&](double t, double pivot) {
      if (std::isnan(pivot)) return;
      if (!(result_.least_pivot <= pivot)) result_.least_pivot = pivot;
      if (pivot >= near_singular) {
        passing_ = false;
        return;
      }
      if (!passing_) result_.passages.push_back({t, pivot});
      passing_ = true;
      RunResult::Passage& last = result_.passages.back();
      last.ambiguous = last.ambiguous || is_ambiguous(t, pivot, between);
      if (!(pivot < last.pivot)) return;
      last.t = t;
      last.pivot = pivot;
    };
    const double end = pivot_at(t1, between);
    const bool careful = !form_.is_dae() && form_.ode()->wants_care() != Care::none;
    if (passing_ || careful || end < 10 * near_singular)
      for (int i = 1; i < closer_looks; ++i) {
        const double t = t0 + (t1 - t0) * i / closer_looks;
        note(t, pivot_at(t, between));
      }
    note(t1, end);
  }

  static bool loses_energy(const Scene& scene) {
    for (const auto& joint : scene.joints)
      if (joint.damping != 0) return true;
    for (const auto& f : scene.forces)
      if ((f.kind == "spring-damper" && f.damping != 0) ||
          (f.kind == "wrench" && (f.in_body_axes || f.torque.norm() > 0)))
        return true;
    return false;
  }

  /// Work done by what the energy does not hold, up to a time in the last step [J].
  double work_until(double t) const {
    if (!(step_end_ > step_from_)) return work_;
    const double part = (t - step_from_) / (step_end_ - step_from_);
    double mean = 0;  // of the power from step_from_ to t
    for (std::size_t i = 0; i < gauss_points.size(); ++i)
      mean += gauss_weights[i] * power_at(part * gauss_points[i]);
    return work_ + mean * (t - step_from_);
  }
  /// The polynomial through the powers, at a fraction of the step.
  double power_at(double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < power_.size(); ++i) {
      double term = power_[i];
      for (std::size_t j = 0; j < power_.size(); ++j)
        if (j != i) term *= (x - gauss_points[j]) / (gauss_points[i] - gauss_points[j]);
      sum += term;
    }
    return sum;
  }

  void row(double t, double energy, double position, double velocity) {
    row_.clear();
    row_.push_back(t);
    row_.insert(row_.end(), now_.q.begin(), now_.q.end());
    row_.insert(row_.end(), now_.u.begin(), now_.u.end());
    e_->markers(markers_.data());
    row_.insert(row_.end(), markers_.begin(), markers_.end());
    row_.push_back(energy);
    if (mechanism_.m() == 0) return;
    row_.push_back(position);
    row_.push_back(velocity);
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
  std::optional<UniqueMultipliers> unique_;
  std::vector<bool> all_unique_;
  Eigen::VectorXd phi_, middle_;
  std::vector<double> markers_, row_, state_;
  Snapshot now_;
  bool loses_energy_;
  double energy_at_start_ = 0, potential_at_start_ = 0, between_ = 0;
  double work_ = 0;  ///< up to step_from_ [J]
  double step_from_ = 0, step_end_ = 0;
  std::array<double, 5> power_{};  ///< at the Gauss points of the last step [W]
  int compared_ = 0;
  long rows_ = 0;  ///< of the trajectory
  Eigen::VectorXd at_rest_, unused_;
  int always_faded_ = std::numeric_limits<int>::max();
  bool passing_ = false;
  double length_ = 1;  ///< of the scene [m]
  std::string trouble_;
};

}  // namespace momenta
