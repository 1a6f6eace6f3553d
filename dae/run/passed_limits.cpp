#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/mechanism/loop/pair_of_loop.h>
#include <momenta/dae/run/passed_limits.h>

#include <algorithm>
#include <cmath>

namespace momenta {

PassedLimits::PassedLimits(const Mechanism& mechanism) {
  const Scene& scene = mechanism.scene();
  for (const JointSpec& joint : scene.joints) {
    if (!joint.limits || joint.restitution) continue;  // rigid stops hold them (rigid_stops.h)
    const auto& body =
        mechanism.tree().bodies[static_cast<std::size_t>(mechanism.tree().carried_by(joint.name))];
    if (body.nq == 0) continue;  // driven
    limited_.push_back({joint.name, *joint.limits, body.nq == 4 ? Of::angle : Of::coordinate,
                        body.q, joint.kind == JointKind::prismatic, has_stops(joint)});
  }
  for (std::size_t i = 0; i < scene.loops.size(); ++i) {
    const LoopSpec& loop = scene.loops[i];
    if (loop.kind != LoopKind::slot || loop.curve.kind != "spline" || loop.curve.closed) continue;
    const double length = pair_of(loop).of_b.samples().back();
    limited_.push_back({loop.name, {0, length}, Of::slot, static_cast<int>(i), true, false});
    places_.resize(scene.loops.size());
  }
  for (const ForceSpec& force : scene.forces)
    if (force.limits) add_force(mechanism, force);
  if (!places_.empty() || !lengths_.empty()) e_ = mechanism.evaluation<double>();
  last_.resize(limited_.size());
}

void PassedLimits::add_force(const Mechanism& mechanism, const ForceSpec& force) {
  const auto number = &force - mechanism.scene().forces.data();
  const std::string name =
      force.name.empty() ? force.kind + " " + std::to_string(number + 1) : force.name;
  Limited l{name, *force.limits,   Of::length, static_cast<int>(lengths_.size()),
            true, has_stops(force)};
  if (force.kind == "spring-damper") {
    limited_.push_back(std::move(l));
    lengths_.push_back(0);
    return;
  }
  const Tree& tree = mechanism.tree();
  l.of = Of::sum;
  l.slides = false;
  for (std::size_t i = 0; i < force.joints.size(); ++i) {
    const int k =
        tree.part_of(force.joints[i], force.coordinates.empty() ? 0 : force.coordinates[i]);
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
    if (b.nq == 0) return;  // driven
    l.slides |= b.kind == JointKind::prismatic;
    l.terms.emplace_back(b.q, force.ratios[i]);
  }
  limited_.push_back(std::move(l));
}

void PassedLimits::values(double t, const double* q, std::vector<double>& x) {
  if (e_) {
    e_->place(t, q);
    if (!places_.empty()) e_->slot_places(places_.data());
    e_->limited_lengths(lengths_.data());
  }
  x.clear();
  for (const Limited& l : limited_) {
    const auto place = static_cast<std::size_t>(l.place);
    switch (l.of) {
      case Of::coordinate:
        x.push_back(q[l.place]);
        break;
      case Of::angle:
        x.push_back(2 * std::atan2(std::hypot(q[l.place + 1], q[l.place + 2], q[l.place + 3]),
                                   std::abs(q[l.place])));
        break;
      case Of::slot:
        x.push_back(places_[place]);
        break;
      case Of::sum:
        x.push_back(0);
        for (const auto& [at, ratio] : l.terms) x.back() += ratio * q[at];
        break;
      case Of::length:
        x.push_back(lengths_[place]);
        break;
    }
  }
}

/// Distance beyond the limits; not positive within them or within rounding.
double PassedLimits::beyond(const Limited& l, double x) {
  constexpr double rounding = 1e-9;  // [rad or m], and of the limit
  const auto past = [](double far, double limit) { return far - rounding * (1 + std::abs(limit)); };
  return std::max(past(l.limits[0] - x, l.limits[0]), past(x - l.limits[1], l.limits[1]));
}

bool PassedLimits::is_of(const PassedLimit& p, const Limited& l) {
  return p.joint == l.name && p.of_force == l.of_force();
}

PassedLimit* PassedLimits::known(Limited& l, std::vector<PassedLimit>& passed) {
  if (l.noted < passed.size() && is_of(passed[l.noted], l)) return &passed[l.noted];
  if (l.noted == nowhere) return nullptr;
  const auto at =
      std::find_if(passed.begin(), passed.end(), [&](const PassedLimit& p) { return is_of(p, l); });
  l.noted = at == passed.end() ? nowhere : static_cast<std::size_t>(at - passed.begin());
  return at == passed.end() ? nullptr : &*at;
}

/// Entry of `l`, made at t if there is none.
PassedLimit& PassedLimits::entry(Limited& l, double t, double x, std::vector<PassedLimit>& passed) {
  if (PassedLimit* p = known(l, passed)) return *p;
  l.noted = passed.size();
  passed.push_back({l.name, l.limits[0], l.limits[1], t, x, t, l.slides, l.stops, l.of == Of::slot,
                    l.of_force()});
  return passed.back();
}

void PassedLimits::look(double t, const double* q, std::vector<PassedLimit>& passed) {
  last_time_ = t;
  values(t, q, last_);
  for (std::size_t i = 0; i < limited_.size(); ++i)
    if (beyond(limited_[i], last_[i]) > 0) entry(limited_[i], t, last_[i], passed);
}

void PassedLimits::step(double t1, const std::function<const double*(double)>& q_at,
                        std::vector<PassedLimit>& passed) {
  const double t0 = last_time_, h = t1 - t0;
  const auto read = [&](double t, std::vector<double>& into) {
    const double* q = q_at(t);
    if (q) values(t, q, into);
    return q != nullptr;
  };
  if (!(h > 0) || !read(t0 + 0.5 * h, middle_) || !read(t1, end_)) return;
  for (std::size_t i = 0; i < limited_.size(); ++i) {
    Limited& l = limited_[i];
    double at = t0, far = last_[i];
    const auto take = [&](double t, double x) {
      if (!(beyond(l, x) > beyond(l, far))) return;
      at = t;
      far = x;
    };
    take(t0 + 0.5 * h, middle_[i]);
    take(t1, end_[i]);
    // x(t0 + s h) = a + b s + c s², extreme at s = −b/2c
    const double c = 2 * (last_[i] + end_[i]) - 4 * middle_[i], b = end_[i] - last_[i] - c;
    const double s = c == 0 ? -1 : -b / (2 * c);
    if (s > 0 && s < 1 && beyond(l, last_[i] + s * (b + c * s)) > 0 && read(t0 + s * h, between_))
      take(t0 + s * h, between_[i]);
    if (!(beyond(l, far) > 0)) continue;
    const bool is_known = known(l, passed) != nullptr;
    double since = at;
    if (!is_known && !(beyond(l, last_[i]) > 0)) {
      double within = t0;
      for (int k = 0; k < 50 && since - within > 1e-12 * std::abs(t1); ++k) {
        const double t = 0.5 * (within + since);
        if (!read(t, between_)) break;
        (beyond(l, between_[i]) > 0 ? since : within) = t;
      }
    }
    PassedLimit& p = entry(l, since, far, passed);
    if (!is_known || beyond(l, far) > beyond(l, p.farthest)) {
      p.farthest = far;
      p.farthest_at = at;
    }
  }
  last_ = end_;
  last_time_ = t1;
}

std::vector<std::string> in_words(const std::vector<PassedLimit>& passed) {
  constexpr std::size_t most = 4;
  std::vector<std::string> all;
  for (std::size_t i = 0; i < passed.size() && i < most; ++i) {
    const PassedLimit& p = passed[i];
    const std::string unit = p.slides ? " m" : " rad";
    all.push_back((p.of_slot    ? "the point in slot "
                   : p.of_force ? "the length of force "
                                : "joint ") +
                  reading::in_quotes(p.joint) +
                  (p.of_slot ? " is beyond its ends ["
                   : p.stops ? " is at its stops beyond ["
                             : " is beyond its limits [") +
                  compact(p.least, 4) + ", " + compact(p.largest, 4) + "]" + unit +
                  " from t = " + compact(p.since, 6) + " s on" +
                  (p.farthest_at == p.since
                       ? ": "
                       : ", farthest at t = " + compact(p.farthest_at, 6) + " s: ") +
                  compact(p.farthest, 6) + unit);
  }
  if (passed.size() > most)
    all.push_back(passed.size() == most + 1
                      ? "so is another"
                      : "so are " + std::to_string(passed.size() - most) + " more");
  return all;
}

}  // namespace momenta
