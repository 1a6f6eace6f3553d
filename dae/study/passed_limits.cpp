#include <momenta/core/text/near_name.h>
#include <momenta/dae/study/passed_limits.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>

namespace momenta {

PassedLimits::PassedLimits(const Mechanism& mechanism) {
  for (const JointSpec& joint : mechanism.scene().joints) {
    if (!joint.limits) continue;
    const auto& body =
        mechanism.tree().bodies[static_cast<std::size_t>(mechanism.tree().carried_by(joint.name))];
    if (body.nq != 1) continue;  // driven
    joints_.push_back(
        {joint.name, *joint.limits, body.q, joint.kind == JointKind::prismatic, has_stops(joint)});
  }
  last_.resize(joints_.size());
}

/// By how much; not positive within the limits, nor where rounding alone is beyond.
double PassedLimits::beyond(const Limited& joint, double q) {
  constexpr double rounding = 1e-9;  // [rad or m], and of the limit
  const auto past = [](double x, double limit) { return x - rounding * (1 + std::abs(limit)); };
  return std::max(past(joint.limits[0] - q, joint.limits[0]),
                  past(q - joint.limits[1], joint.limits[1]));
}

/// What is known of the joint, or the note that it passes at t.
PassedLimit& PassedLimits::entry(const Limited& joint, double t, double q,
                                 std::vector<PassedLimit>& passed) {
  for (PassedLimit& p : passed)
    if (p.joint == joint.name) return p;
  passed.push_back(
      {joint.name, joint.limits[0], joint.limits[1], t, q, t, joint.slides, joint.stops});
  return passed.back();
}

void PassedLimits::look(double t, const double* q, std::vector<PassedLimit>& passed) {
  last_time_ = t;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    last_[i] = q[joints_[i].q];
    if (beyond(joints_[i], last_[i]) > 0) entry(joints_[i], t, last_[i], passed);
  }
}

void PassedLimits::step(double t1, const std::function<const double*(double)>& q_at,
                        std::vector<PassedLimit>& passed) {
  const double t0 = last_time_, h = t1 - t0;
  const auto read = [&](double t, std::vector<double>& into) {
    const double* q = q_at(t);
    into.clear();
    for (const Limited& joint : joints_) into.push_back(q ? q[joint.q] : NAN);
    return q != nullptr;
  };
  if (!(h > 0) || !read(t0 + 0.5 * h, middle_) || !read(t1, end_)) return;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Limited& joint = joints_[i];
    double at = t0, far = last_[i];
    const auto take = [&](double t, double q) {
      if (!(beyond(joint, q) > beyond(joint, far))) return;
      at = t;
      far = q;
    };
    take(t0 + 0.5 * h, middle_[i]);
    take(t1, end_[i]);
    // q(t0 + x h) = a + b x + c x², extreme at x = −b/2c
    const double c = 2 * (last_[i] + end_[i]) - 4 * middle_[i], b = end_[i] - last_[i] - c;
    const double x = c == 0 ? -1 : -b / (2 * c);
    if (x > 0 && x < 1 && beyond(joint, last_[i] + x * (b + c * x)) > 0)
      if (const double* q = q_at(t0 + x * h)) take(t0 + x * h, q[joint.q]);
    if (!(beyond(joint, far) > 0)) continue;
    const bool known = std::any_of(passed.begin(), passed.end(),
                                   [&](const PassedLimit& p) { return p.joint == joint.name; });
    double since = at;
    if (!known && !(beyond(joint, last_[i]) > 0)) {
      double within = t0;
      for (int k = 0; k < 50 && since - within > 1e-12 * std::abs(t1); ++k) {
        const double t = 0.5 * (within + since);
        const double* q = q_at(t);
        if (!q) break;
        (beyond(joint, q[joint.q]) > 0 ? since : within) = t;
      }
    }
    PassedLimit& p = entry(joint, since, far, passed);
    if (!known || beyond(joint, far) > beyond(joint, p.farthest)) {
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
    all.push_back(
        "joint " + reading::in_quotes(p.joint) +
        (p.stops ? " is at its stops beyond [" : " is beyond its limits [") + compact(p.least, 4) +
        ", " + compact(p.largest, 4) + "]" + unit + " from t = " + compact(p.since, 6) + " s on" +
        (p.farthest_at == p.since ? ": "
                                  : ", farthest at t = " + compact(p.farthest_at, 6) + " s: ") +
        compact(p.farthest, 6) + unit);
  }
  if (passed.size() > most)
    all.push_back(passed.size() == most + 1
                      ? "so is another joint"
                      : "so are " + std::to_string(passed.size() - most) + " joints more");
  return all;
}

}  // namespace momenta
