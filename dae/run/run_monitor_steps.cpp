// The run monitor between the samples: drift and power inside steps, limits and singular poses that
// are passed, events, frames of the film.

#include <momenta/dae/run/run_monitor.h>

#include <algorithm>
#include <cmath>

namespace momenta {

bool RunMonitor::step(double t0, double t1, const Interpolant& between) {
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

bool RunMonitor::look_between(double t0, double t1, const Interpolant& between, bool inside) {
  if (request_.film_intervals > 0) film_until(t1, between);
  if (mechanism_.m() > 0) {
    if (!look_at_middle(0.5 * (t0 + t1), between)) return true;
    if (!came_apart_.empty()) return false;
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
  if (errors_.measures_own() && (errors_.sees_every_step() || sample_before(t1 * (1 + 1e-12))))
    errors_.step(t0, t1, between, state_);
  if ((works_ || drives_->any()) && !work_.step(t0, t1, inside || sample_before(t1 * (1 - 1e-12)),
                                                [&](double t, double& watts, double& flow) {
                                                  return power(t, between, watts, flow);
                                                }))
    return true;
  return !request_.going_on || request_.going_on();
}

/// The drift in the middle of the step. False: the state there cannot be read.
bool RunMonitor::look_at_middle(double t, const Interpolant& between) {
  between(t, state_.data());
  if (!read_coordinates(t)) return false;
  const Drift drift = position_drift(t, middle_);
  departures_.look_between(std::abs(e_->potential(middle_.data()) - potential_at_start_));
  if (!(drift.lengths <= largest_between_.lengths)) largest_between_.lengths = drift.lengths;
  if (!(drift.angles <= largest_between_.angles)) largest_between_.angles = drift.angles;
  if (drift.finite()) came_apart_ = apart_->found(t, phi_, false);
  if (came_apart_.empty()) keep_closed(t, middle_);
  return true;
}

bool RunMonitor::power(double t, const Interpolant& between, double& watts, double& flow) {
  between(t, state_.data());
  if (!read(t, state_.data(), nullptr)) return false;
  watts = flow = 0;
  const auto add = [&](double power) {
    watts += power;
    flow += std::abs(power);
  };
  if (works_) {
    e_->place(t, now_.q.data());
    e_->move(now_.u.data());
    add(e_->dissipated_power(now_.q.data(), now_.u.data()));
    if (friction_) {
      if (!friction_->at(t, now_.q.data(), now_.u.data())) return false;
      add(friction_->power(now_.u.data()));
    }
  }
  if (drives_->any()) add(drives_->at(t, now_.q.data(), now_.u.data()));
  return true;
}

bool RunMonitor::read_coordinates(double t) {
  Eigen::VectorXd& of_form = written_ ? of_form_.q : middle_;
  if (!form_->read_coordinates(t, state_.data(), of_form)) return false;
  if (written_) written_->read_coordinates(t, of_form, middle_);
  return true;
}

bool RunMonitor::read_at(double t, bool exact, bool rates, const Eigen::VectorXd*& q,
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

std::vector<double> RunMonitor::row_at(double t) {
  take_state_at(t);
  if (!request_.keep_trajectory || !read(t, state_.data(), nullptr)) return {};
  const Measured now = measure(t, position_drift(t, now_.q));
  row_.set(t, now_, *e_, now.energy, now.position, now.velocity);
  return kept_row();
}

bool RunMonitor::sample_before(double t) {
  const std::vector<double>& times = *output_times_;
  const std::vector<double>& seen = result_.series.t;
  while (next_ < times.size() && !seen.empty() && times[next_] <= seen.back()) ++next_;
  return next_ < times.size() && times[next_] <= t;
}

bool RunMonitor::sample_until(double t) {
  while (sample_before(t)) {
    const double at = (*output_times_)[next_];
    take_state_at(at);
    if (!sample(at, state_.data(), nullptr)) return false;
  }
  return true;
}

bool RunMonitor::meet(double t, const std::vector<EventWatch::Found>& found) {
  if (!sample_until(t)) return false;
  take_state_at(t);
  if (!read(t, state_.data(), nullptr)) return false;
  hit_ = Hit{t, now_.q, now_.u, {}};
  for (const EventWatch::Found& f : found)
    if (events_->is_stop(f)) hit_->stops.push_back(f.event - events_->first_stop());
  return false;
}

bool RunMonitor::end_at(double t, const EventWatch::Found& event) {
  // An output time this near is the event.
  const double near = 1e-9 * result_.settings.end_time / result_.settings.samples;
  if (!sample_until(t - near)) return false;
  take_state_at(t);
  if (result_.series.t.back() < t - near && !sample(t, state_.data(), nullptr)) return false;
  ended_at_ = t;
  ended_by_ = "event '" + events_->name(event.event) + "' (" + (event.crossing.up ? "up" : "down") +
              ") ended the run at t = " + compact(t, 8) + " s";
  return false;
}

void RunMonitor::film_until(double t1, const Interpolant& between) {
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

}  // namespace momenta
