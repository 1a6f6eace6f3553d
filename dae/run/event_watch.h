#pragma once
// The events of a scene along a run (event/crossings.h): their numbers at the Chebyshev points of
// each step, each state read once for all of them, and roots read off the dense output. Where the
// ends of steps are more accurate than that, a root is moved to that of the exact output next to
// it. Beside the scene's, numbers of rigid stops are watched, whose roots end the phase of a run.

#include <momenta/core/text/number_text.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/run/event/bracketed_root.h>
#include <momenta/dae/run/event/crossings.h>
#include <momenta/dae/run/event/event_values.h>
#include <momenta/dae/run/rigid_stops.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace momenta {

class EventWatch {
 public:
  /// An event and its crossing.
  struct Found {
    std::size_t event;
    Crossing crossing;
  };
  /// Reads q (nq), and u (nv) if `rates`, at a time in the last step, off the dense or the exact
  /// output; false: not readable.
  using Read = std::function<bool(double t, bool exact, bool rates, const Eigen::VectorXd*& q,
                                  const Eigen::VectorXd*& u)>;

  /// `span` [s]: roots are found to 1e-13 of it. `stops`: null, or stops that outlive this.
  EventWatch(const Mechanism& mechanism, std::vector<EventSpec> events, double span, Read read,
             RigidStops* stops)
      : events_(std::move(events)),
        stops_(stops),
        all_events_(events_.size() + (stops ? stops->size() : 0)),
        values_(mechanism, events_),
        tolerance_(1e-13 * span),
        read_(std::move(read)),
        crossings_(all_events_, Crossings(tolerance_)),
        told_(all_events_),
        at_points_(Crossings::points, std::vector<double>(all_events_)),
        all_(all_events_),
        signs_(events_.size()) {
    for (std::size_t k = 0; k < all_events_; ++k)
      of_event_.emplace_back([this, k](double t) { return value(t, k, false); });
  }

  /// Whether the event ends the run or its phase.
  bool ends(const Found& f) const { return is_stop(f) || events_[f.event].stop; }
  /// Whether the event is of a rigid stop, number `event` − first_stop().
  bool is_stop(const Found& f) const { return f.event >= events_.size(); }
  std::size_t first_stop() const { return events_.size(); }
  std::string name(std::size_t k) const { return name_of(events_[k], k); }
  /// Tells that the method has an output more accurate than its dense one.
  void has_exact() { exact_ = true; }

  /// Events of a step by time, up to the first that ends the run or its phase, and stops at that
  /// very time.
  const std::vector<Found>& step(double t0, double t1, std::vector<std::string>& remarks) {
    found_.clear();
    passed_.clear();
    for (std::size_t k = 0; k < first_stop(); ++k) signs_[k] = crossings_[k].sign();
    // The next impact at a stop may follow within the step, but not before the pause is over:
    // earlier roots are errors of the dense output.
    if (pause_until_ > t0 && pause_until_ < t1) {
      const double until = pause_until_;
      interval(t0, until, remarks);
      for (std::size_t k = first_stop(); k < all_events_; ++k)
        if (pausing(k)) crossings_[k].restart_below_zero(until);
      pause_until_ = t0;
      interval(until, t1, remarks);
    } else {
      interval(t0, t1, remarks);
    }
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Found& a, const Found& b) { return a.crossing.t < b.crossing.t; });
    const auto end =
        std::find_if(found_.begin(), found_.end(), [&](const Found& f) { return ends(f); });
    if (end != found_.end() && is_stop(*end)) {
      phase_ends(end->crossing.t);
    } else if (end != found_.end()) {
      found_.erase(end + 1, found_.end());
    }
    return found_;
  }

  /// Restarts the crossings of stops after an impact or a release.
  void restart(double t) {
    for (std::size_t k = first_stop(); k < all_events_; ++k)
      if (stops_->ends_upwards(k - first_stop()))
        crossings_[k].restart_below_zero(t);
      else
        crossings_[k].restart();
    pause_until_ = t + stops_->pause();
  }

  void carry(Memory& memory) {
    for (Crossings& c : crossings_) c.carry(memory);
    memory(told_);
  }

 private:
  void interval(double t0, double t1, std::vector<std::string>& remarks) {
    for (std::size_t i = 0; i < Crossings::points; ++i)
      values_at(Crossings::point(t0, t1, i), false, at_points_[i]);
    for (std::size_t k = 0; k < all_events_; ++k) {
      Crossings::Values values;
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = at_points_[i][k];
      if (k < events_.size()) note_missing(k, t0, t1, values, remarks);
      of_one_.clear();
      crossings_[k].step(t0, t1, values, of_event_[k], of_one_);
      for (Crossing& c : of_one_) {
        const bool told = wanted(k, c.up);
        if (k >= first_stop() && (!told || (c.t < pause_until_ && pausing(k)))) continue;
        if (exact_) c.t = exact_root(c.t, k, t0, t1);
        (told ? found_ : passed_).push_back({k, c});
      }
    }
  }
  /// Ends the phase at a stop, and stops met at the same time. The rest of the step is no motion:
  /// events keep the signs from before t, so that one turned by the impact is found as the next
  /// phase begins.
  void phase_ends(double t) {
    const double same = 10 * tolerance_;
    for (std::size_t k = 0; k < first_stop(); ++k) {
      for (std::size_t i = 0; i < Crossings::points && signs_[k] == 0; ++i)
        signs_[k] = at_points_[i][k] > 0 ? 1 : at_points_[i][k] < 0 ? -1 : 0;
      double last = -std::numeric_limits<double>::infinity();
      for (const std::vector<Found>* all : {&found_, &passed_})
        for (const Found& f : *all)
          if (f.event == k && f.crossing.t <= t - same && f.crossing.t >= last) {
            last = f.crossing.t;
            signs_[k] = f.crossing.up ? 1 : -1;
          }
      crossings_[k].restart_with(signs_[k]);
    }
    std::erase_if(
        found_, [&](const Found& f) { return f.crossing.t > (is_stop(f) ? t + same : t - same); });
  }
  bool pausing(std::size_t k) const {
    return k >= first_stop() && stops_->was_met(k - first_stop());
  }
  bool wanted(std::size_t k, bool up) const {
    if (k >= events_.size()) return stops_->ends_upwards(k - events_.size()) == up;
    return events_[k].direction == "both" || (events_[k].direction == "up") == up;
  }
  void values_at(double t, bool exact, std::vector<double>& values) {
    const Eigen::VectorXd *q = nullptr, *u = nullptr;
    const bool rates = values_.takes_rates() || (stops_ && stops_->any_held());
    if (read_(t, exact, rates, q, u)) {
      values_.at(t, *q, u ? *u : *q, values.data());
      for (std::size_t k = events_.size(); k < all_events_; ++k)
        values[k] = stops_->value(k - events_.size(), t, *q, u ? *u : *q);
    } else {
      std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  double value(double t, std::size_t k, bool exact) {
    values_at(t, exact, all_);
    return all_[k];
  }

  /// The root of the exact output nearest to t; t where there is none in the step.
  double exact_root(double t, std::size_t k, double t0, double t1) {
    const auto g = [&](double x) { return value(x, k, true); };
    const double at = g(t);
    if (at == 0 || at == value(t, k, false)) return t;  // the same output
    for (double width = 1e-6 * (t1 - t0);; width *= 8) {
      const double a = std::max(t0, t - width), b = std::min(t1, t + width);
      const double at_a = g(a), at_b = g(b);
      if (std::signbit(at_a) != std::signbit(at)) return root(g, a, at_a, t, at);
      if (std::signbit(at_b) != std::signbit(at)) return root(g, t, at, b, at_b);
      if (std::isnan(at_a + at + at_b) || (a == t0 && b == t1)) return t;
    }
  }
  template <class G>
  double root(const G& g, double a, double at_a, double b, double at_b) const {
    const double found = bracketed_root(g, a, at_a, b, at_b, tolerance_).at;
    return std::isnan(found) ? 0.5 * (a + b) : found;
  }

  /// Remarks, once per event, that it has no value.
  void note_missing(std::size_t k, double t0, double t1, const Crossings::Values& values,
                    std::vector<std::string>& remarks) {
    if (told_[k]) return;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::isnan(values[i])) {
        told_[k] = 1;
        remarks.push_back("event '" + name(k) + "': '" + events_[k].when.text +
                          "' has no value at t = " + compact(Crossings::point(t0, t1, i), 6) +
                          " s, and wherever it has none no event is found");
        return;
      }
  }

  std::vector<EventSpec> events_;
  RigidStops* stops_;
  std::size_t all_events_;  ///< count of events and stops
  double pause_until_ = 0;  ///< before it no stop is met again [s]
  EventValues values_;
  double tolerance_;
  Read read_;
  bool exact_ = false;
  std::vector<Crossings> crossings_;
  std::vector<char> told_;
  std::vector<std::vector<double>> at_points_;
  std::vector<double> all_;
  std::vector<std::function<double(double)>> of_event_;
  std::vector<Found> found_, passed_;  ///< events of the step, and in other directions
  std::vector<int> signs_;             ///< signs of events before the step
  std::vector<Crossing> of_one_;
};

}  // namespace momenta
