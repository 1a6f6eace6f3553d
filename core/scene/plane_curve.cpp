#include <momenta/core/scene/plane_curve.h>
#include <momenta/core/text/quoting.h>

#include <numbers>

namespace momenta {
namespace {

constexpr double flat_slack =
    1e-9;  // distance of points from the plane, over their largest coordinate
constexpr double direction_slack = 1e-6;  // for directions: off the plane, and off unit length
constexpr std::size_t samples_of_turn = 96, samples_of_chord = 8;

std::string spline_fault(const CurveSpec& spec, const Eigen::Vector3d& axis) {
  const auto& p = spec.points;
  const std::size_t least = spec.closed ? 3 : 2;
  if (p.size() < least)
    return "has " + std::to_string(p.size()) + " points, expected at least " +
           std::to_string(least) + (spec.closed ? " of a closed spline" : "");
  double size = 0;
  for (const auto& x : p) size = std::max(size, x.allFinite() ? x.norm() : HUGE_VAL);
  if (!std::isfinite(size)) return "has points that are not finite [m]";
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::string which = "points[" + std::to_string(i) + "]";
    if (const double off = std::abs(axis.dot(p[i])); off > flat_slack * size)
      return which + " is " + reading::digits(off) +
             " m off the plane through the origin across axis, expected points of that plane";
    const std::size_t next = i + 1 < p.size() ? i + 1 : 0;
    if ((next > 0 || spec.closed) && !((p[next] - p[i]).norm() > flat_slack * size))
      return "points[" + std::to_string(next) + "] is the same as " + which +
             ", expected another point" +
             (next == 0 ? " (a closed spline goes back to the first by itself)" : "");
  }
  return "";
}

std::string direction_fault(const CurveSpec& spec, const Eigen::Vector3d& axis, bool may_be_zero) {
  if (may_be_zero && spec.direction.isZero(0)) return "";
  if (!(std::abs(spec.direction.norm() - 1) <= direction_slack))
    return "must be a unit vector within 1e-6";
  if (!(std::abs(axis.dot(spec.direction)) <= direction_slack))
    return "is not at right angles to axis, expected a direction across it";
  return "";
}

}  // namespace

std::string curve_fault(const CurveSpec& spec, const Eigen::Vector3d& axis) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (spec.kind == "circle")
    return positive(spec.radius) ? "" : "radius must be finite and > 0 [m]";
  if (spec.kind == "ellipse") {
    if (!positive(spec.semi_axes[0]) || !positive(spec.semi_axes[1]))
      return "semi_axes must be finite and > 0 [m]";
    const std::string fault = direction_fault(spec, axis, true);
    return fault.empty() ? "" : "direction " + fault;
  }
  if (spec.kind == "spline") return spline_fault(spec, axis);
  if (spec.kind == "flat") {
    const std::string fault = direction_fault(spec, axis, false);
    return fault.empty() ? "" : "normal " + fault;
  }
  return "kind must be circle, ellipse, spline or flat";
}

PlaneCurve::PlaneCurve(const CurveSpec& spec, const Eigen::Vector3d& e1,
                       const Eigen::Vector3d& e2) {
  const auto in_plane = [&](const Eigen::Vector3d& v) {
    return std::array<double, 2>{e1.dot(v), e2.dot(v)};
  };
  if (spec.kind == "flat") {
    const auto n = in_plane(spec.direction);
    const double norm = std::hypot(n[0], n[1]);
    e_ = {n[1] / norm, -n[0] / norm};  // the normal is to the left
    return;
  }
  if (spec.kind == "spline") {
    kind_ = Kind::spline;
    std::vector<double> x, y, s{0};
    for (const auto& point : spec.points) {
      const auto p = in_plane(point);
      if (!x.empty()) s.push_back(s.back() + std::hypot(p[0] - x.back(), p[1] - y.back()));
      x.push_back(p[0]);
      y.push_back(p[1]);
    }
    if (spec.closed) {
      period_ = s.back() + std::hypot(x.front() - x.back(), y.front() - y.back());
      coordinates_ = {CubicSpline(s, x, period_), CubicSpline(s, y, period_)};
      s.push_back(period_);
    } else {
      coordinates_ = {CubicSpline(s, x), CubicSpline(s, y)};
    }
    for (std::size_t i = 0; i + 1 < s.size(); ++i)
      for (std::size_t k = 0; k < samples_of_chord; ++k)
        samples_.push_back(s[i] + (s[i + 1] - s[i]) * static_cast<double>(k) /
                                      static_cast<double>(samples_of_chord));
    if (!spec.closed) samples_.push_back(s.back());
  } else {
    kind_ = Kind::ellipse;
    if (!spec.direction.isZero(0)) e_ = in_plane(spec.direction);
    semi_axes_ =
        spec.kind == "circle" ? std::array<double, 2>{spec.radius, spec.radius} : spec.semi_axes;
    period_ = 2 * std::numbers::pi;
    for (std::size_t k = 0; k < samples_of_turn; ++k)
      samples_.push_back(period_ * static_cast<double>(k) / static_cast<double>(samples_of_turn));
  }
  double twice_area = 0;
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const auto p = at(samples_[k]).p, next = at(samples_[(k + 1) % samples_.size()]).p;
    twice_area += p[0] * next[1] - p[1] * next[0];
    reach_ = std::max(reach_, std::hypot(p[0], p[1]));
    sampled_.push_back(at(samples_[k]));
  }
  outward_ = twice_area > 0 ? -1 : 1;
}

}  // namespace momenta
