#include <momenta/core/scene/joint_formula.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {

std::string Scene::where(Location at) const {
  const auto other = static_cast<std::size_t>(at.file);
  const std::string& from = other > 0 && other <= included.size() ? included[other - 1] : file;
  std::string prefix = from.empty() ? std::string("scene") : reading::on_one_line(from);
  if (at.line > 0) prefix += ":" + std::to_string(at.line);
  if (at.line > 0 && at.column > 0) prefix += ":" + std::to_string(at.column);
  return prefix + ": ";
}

int coordinates_of(const JointSpec& joint) {
  return joint.kind == JointKind::user ? (joint.law ? joint.law->coordinates() : 0)
                                       : coordinates_of(joint.kind);
}
int rates_of(const JointSpec& joint) {
  return joint.kind == JointKind::user ? coordinates_of(joint) : rates_of(joint.kind);
}

bool has_powers(const LoopSpec& loop) {
  return std::any_of(loop.powers.begin(), loop.powers.end(), [](double x) { return x != 0; });
}

bool has_stops(const JointSpec& joint) {
  return joint.limits && (joint.stop_stiffness != 0 || joint.stop_damping != 0);
}
bool has_stops(const ForceSpec& force) {
  return force.limits && (force.stop_stiffness != 0 || force.stop_damping != 0);
}

std::string with_ends(const std::string& word, const ForceSpec& force) {
  return word + (force.name.empty() ? "" : " " + reading::in_quotes(force.name)) + " from " +
         reading::in_quotes(force.parent) + " to " + reading::in_quotes(force.child);
}

bool ties_bodies(const LoopSpec& loop) {
  return loop.kind != LoopKind::coupler && !has_equation(loop);
}

bool has_equation(const LoopSpec& loop) {
  return loop.kind == LoopKind::equation || loop.kind == LoopKind::velocity_equation;
}

bool has_curves(const LoopSpec& loop) {
  return loop.kind == LoopKind::cam || loop.kind == LoopKind::rack ||
         (loop.kind == LoopKind::slot && !loop.curve.kind.empty());
}

bool has_rotor(const JointSpec& joint) {
  return std::any_of(joint.rotor_inertia.begin(), joint.rotor_inertia.end(),
                     [](double x) { return x != 0; });
}

Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis) {
  constexpr double tie = 1e-9;  // axes this near count as equally near, whatever rounding
  const Eigen::Vector3d a = axis.normalized();
  int nearest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(a[i]) > std::abs(a[nearest]) + tie) nearest = i;
  const Eigen::Vector3d next = Eigen::Vector3d::Unit((nearest + 1) % 3);
  return (next - next.dot(a) * a).normalized();
}

std::string name_of(const EventSpec& event, std::size_t place) {
  return event.name.empty() ? "event " + std::to_string(place + 1) : event.name;
}

namespace {

/// Diagonal, by body and for the ground, of the box around its points: O(points).
std::map<std::string, double> diagonals(const Scene& scene) {
  struct Points {
    Eigen::Vector3d low, high;
  };
  std::map<std::string, Points> bodies;
  const auto on = [&](const std::string& body, const Eigen::Vector3d& x) {
    const auto [at, is_new] = bodies.try_emplace(body, Points{x, x});
    if (is_new) return;
    at->second.low = at->second.low.cwiseMin(x);
    at->second.high = at->second.high.cwiseMax(x);
  };
  for (const BodySpec& b : scene.bodies)
    if (b.mass > 0) on(b.name, b.com);
  const auto ends = [&](const auto& x) {
    on(x.parent, x.origin_parent);
    on(x.child, x.origin_child);
  };
  for (const JointSpec& j : scene.joints) ends(j);
  const auto outline = [&](const std::string& body, const Eigen::Vector3d& at,
                           const Eigen::Quaterniond& turn, const CurveSpec& curve) {
    const double reach = std::max({curve.radius, curve.semi_axes[0], curve.semi_axes[1]});
    for (const double r : {-reach, reach})
      on(body, at + Eigen::Vector3d::Constant(r / std::sqrt(3)));
    for (const auto& point : curve.points) on(body, at + turn * point);
  };
  for (const LoopSpec& l : scene.loops) {
    if (!ties_bodies(l)) continue;
    ends(l);
    if (!l.curve.kind.empty()) outline(l.parent, l.origin_parent, l.rotation, l.curve);
    if (!l.child_curve.kind.empty())
      outline(l.child, l.origin_child, Eigen::Quaterniond::Identity(), l.child_curve);
  }
  for (const ForceSpec& f : scene.forces) {
    if (f.kind == "spring-damper" || f.kind == "bushing") ends(f);
    if (f.kind == "wrench") on(f.body, f.point);
  }
  for (const MarkerSpec& m : scene.markers) on(m.body, m.point);
  std::map<std::string, double> found;
  for (const auto& [name, points] : bodies) found[name] = (points.high - points.low).norm();
  return found;
}

}  // namespace

double length_of(const Scene& scene) {
  double length = 0;
  for (const LoopSpec& l : scene.loops) {
    length = std::max(length, l.length);
    if (ties_bodies(l) && l.kind == LoopKind::rolling) length = std::max(length, l.radius);
  }
  for (const auto& [body, diagonal] : diagonals(scene)) length = std::max(length, diagonal);
  return length > 0 ? length : 1;
}

double length_of_bodies(const Scene& scene) {
  double length = 0;
  for (const auto& [body, diagonal] : diagonals(scene))
    if (body != "ground") length = std::max(length, diagonal);
  return length > 0 ? length : length_of(scene);
}

}  // namespace momenta
