#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/validate.h>
#include <momenta/dae/topology/cut/fold_welds.h>
#include <momenta/dae/topology/cut/interchange.h>

#include <set>
#include <unordered_map>

namespace momenta {

BodySpec merged_body(BodySpec first, const BodySpec& second, const Eigen::Quaterniond& turn,
                     const Eigen::Vector3d& origin) {
  if (second.mass == 0 && second.inertia.isZero(0)) return first;
  const Eigen::Matrix3d r = turn.toRotationMatrix();
  const Eigen::Vector3d d = origin + r * second.com - first.com;
  first.inertia += r * second.inertia * r.transpose();
  if (second.mass > 0) {
    const double mass = first.mass + second.mass, share = second.mass / mass;
    first.inertia +=
        first.mass * share * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
    first.com = first.mass > 0 ? Eigen::Vector3d(first.com + share * d)
                               : Eigen::Vector3d(origin + r * second.com);
    first.mass = mass;
  }
  first.inertia = (0.5 * (first.inertia + first.inertia.transpose())).eval();
  first.any_inertia |= second.any_inertia;
  first.shape = {};
  return first;
}

namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// A body's place in its carrier. A quaternion, so that joints without a turn keep their digits.
struct Place {
  std::string carrier;
  Quaterniond turn = Quaterniond::Identity();
  Vector3d origin = Vector3d::Zero();

  bool turned() const { return turn.vec() != Vector3d::Zero(); }
  Vector3d point(const Vector3d& x) const {
    return turned() ? Vector3d(origin + turn * x) : Vector3d(origin + x);
  }
  Vector3d direction(const Vector3d& a) const { return turned() ? Vector3d(turn * a) : a; }
};

/// The place of every body, and of the ground.
class Places {
 public:
  Places(const Scene& scene, const std::set<std::string>& kept) {
    places_["ground"] = {"ground"};
    std::unordered_map<std::string, const JointSpec*> inward;
    for (const JointSpec& joint : scene.joints) {
      const bool folds = joint.kind == JointKind::weld && !kept.contains(joint.name);
      if (folds)
        inward[joint.child] = &joint;
      else
        places_[joint.child] = {joint.child};
    }
    std::vector<const JointSpec*> way;  // towards a known place
    for (const JointSpec& joint : scene.joints) {
      way.clear();
      for (std::string body = joint.child; !places_.contains(body); body = way.back()->parent)
        way.push_back(inward.at(body));
      for (; !way.empty(); way.pop_back()) {
        const JointSpec& weld = *way.back();
        Place place = places_.at(weld.parent);
        place.origin = place.point(weld.origin_parent);
        place.turn = (place.turn * weld.rotation).normalized();
        place.origin -= place.direction(weld.origin_child);
        places_[weld.child] = place;
      }
    }
  }
  const Place& of(const std::string& body) const { return places_.at(body); }
  bool carries(const std::string& body) const { return of(body).carrier == body; }

 private:
  std::unordered_map<std::string, Place> places_;
};

/// Loops that drives prescribe, by name.
struct DrivenLoops {
  std::set<std::string> any, origins;
  explicit DrivenLoops(const Scene& scene) {
    for (const DriveSpec& drive : scene.drives) {
      if (drive.loop.empty()) continue;
      any.insert(drive.loop);
      if (!drive.origin.empty()) origins.insert(drive.loop);
    }
  }
};

/// Bodies whose own weld must stay for the loops; none: they can be re-expressed.
std::set<std::string> held_by_loops(const Scene& scene, const Places& places,
                                    const DrivenLoops& driven) {
  std::set<std::string> bodies;
  for (const LoopSpec& loop : scene.loops) {
    if (!ties_bodies(loop)) continue;
    const Place &parent = places.of(loop.parent), &child = places.of(loop.child);
    if (parent.carrier == child.carrier)
      bodies.insert(places.carries(loop.child) ? loop.parent : loop.child);
    else if (driven.origins.contains(loop.name) && !places.carries(loop.parent))
      bodies.insert(loop.parent);
    else if ((driven.any.contains(loop.name) || !can_turn_round(loop)) &&
             (child.carrier == "ground" || (loop.kind == LoopKind::spherical && child.turned())))
      bodies.insert(loop.child);
  }
  return bodies;
}

bool has_ends(const ForceSpec& f) {
  return f.kind == "spring-damper" || f.kind == "bushing";
}

/// Bodies whose own weld must stay for forces: the child of a bushing with damping that would be
/// ground, since velocities at its point are not those at the parent's; an end of a spring whose
/// length formulas name and whose ends would be on one body; bodies in whose axes components are.
std::set<std::string> held_by_forces(const Scene& scene, const NamedInFormulas& named,
                                     const Places& places) {
  std::set<std::string> bodies;
  for (const ForceSpec& f : scene.forces) {
    const bool on_one = has_ends(f) && places.of(f.parent).carrier == places.of(f.child).carrier;
    if (on_one && named.springs.contains(f.name))
      bodies.insert(places.carries(f.child) ? f.parent : f.child);
    if (f.kind == "bushing" && f.damping != 0 && !on_one && places.of(f.child).carrier == "ground")
      bodies.insert(f.child);
    if (f.in_body_axes && has_formula(f) && places.of(f.body).turned()) bodies.insert(f.body);
  }
  return bodies;
}

LoopSpec folded(LoopSpec loop, const Places& places) {
  const Place &parent = places.of(loop.parent), &child = places.of(loop.child);
  loop.parent = parent.carrier;
  loop.child = child.carrier;
  loop.origin_parent = parent.point(loop.origin_parent);
  loop.origin_child = child.point(loop.origin_child);
  if (parent.turned()) loop.rotation = parent.turn * loop.rotation;
  if (child.turned()) {
    if (loop.kind == LoopKind::universal && loop.axis2.isZero())
      loop.axis2 = perpendicular_to(loop.axis);
    if ((loop.kind == LoopKind::planar || loop.kind == LoopKind::rack) && loop.direction.isZero())
      loop.direction = perpendicular_to(loop.axis);
    for (CurveSpec* curve : {&loop.curve, &loop.child_curve}) {
      if (curve->kind == "ellipse" && curve->direction.isZero())
        curve->direction = perpendicular_to(loop.axis);
      curve->direction = child.turn * curve->direction;
      for (Vector3d& point : curve->points) point = child.turn * point;
    }
    loop.rotation = loop.rotation * child.turn.conjugate();
    for (Vector3d* a : {&loop.axis, &loop.axis2, &loop.direction, &loop.normal})
      *a = child.turn * *a;
  }
  if (loop.child == "ground") loop = reversed(loop);
  return loop;
}

/// Merges bodies into their carriers.
void merge_bodies(const Scene& given, const Places& places, Scene& scene) {
  std::erase_if(scene.bodies, [&](const BodySpec& body) { return !places.carries(body.name); });
  std::unordered_map<std::string, BodySpec*> carriers;
  for (BodySpec& body : scene.bodies) carriers[body.name] = &body;
  for (const BodySpec& body : given.bodies) {
    const Place& place = places.of(body.name);
    if (place.carrier == body.name || place.carrier == "ground") continue;
    BodySpec& carrier = *carriers.at(place.carrier);
    carrier = merged_body(carrier, body, place.turn, place.origin);
  }
}

void fold_forces(const Places& places, Scene& scene) {
  std::erase_if(scene.forces, [&](const ForceSpec& f) {
    if (has_ends(f)) return places.of(f.parent).carrier == places.of(f.child).carrier;
    return f.kind == "wrench" && places.of(f.body).carrier == "ground";
  });
  for (ForceSpec& f : scene.forces)
    if (has_ends(f)) {
      const Place &parent = places.of(f.parent), &child = places.of(f.child);
      f.origin_parent = parent.point(f.origin_parent);
      f.origin_child = child.point(f.origin_child);
      f.rotation = (parent.turn * f.rotation * child.turn.conjugate()).normalized();
      f.parent = parent.carrier;
      f.child = child.carrier;
      if (f.child != "ground") continue;
      std::swap(f.parent, f.child);
      std::swap(f.origin_parent, f.origin_child);
      f.rotation = f.rotation.conjugate();
    } else if (f.kind == "wrench") {
      const Place& place = places.of(f.body);
      f.body = place.carrier;
      f.point = place.point(f.point);
      if (!f.in_body_axes) continue;
      f.force = place.direction(f.force);
      f.torque = place.direction(f.torque);
    }
}

}  // namespace

FoldedScene fold_welds(const Scene& given) {
  validate(given);
  FoldedScene result;
  result.scene = given;
  std::unordered_map<std::string, std::string> weld_of;
  for (const JointSpec& joint : given.joints)
    if (joint.kind == JointKind::weld) weld_of[joint.child] = joint.name;
  if (weld_of.empty() || weld_of.size() == given.joints.size()) return result;
  const DrivenLoops driven(given);
  std::set<std::string> kept;
  Places places(given, kept);
  const NamedInFormulas named(given);
  const auto held_now = [&] {
    std::set<std::string> held = held_by_loops(given, places, driven);
    held.merge(held_by_forces(given, named, places));
    return held;
  };
  for (auto held = held_now(); !held.empty(); held = held_now()) {
    for (const std::string& body : held) kept.insert(weld_of.at(body));
    places = Places(given, kept);
  }

  Scene& scene = result.scene;
  merge_bodies(given, places, scene);
  std::erase_if(scene.joints, [&](const JointSpec& j) { return !places.carries(j.child); });
  for (JointSpec& joint : scene.joints) {
    const Place& parent = places.of(joint.parent);
    joint.parent = parent.carrier;
    joint.origin_parent = parent.point(joint.origin_parent);
    if (parent.turned()) joint.rotation = parent.turn * joint.rotation;
  }
  for (LoopSpec& loop : scene.loops)
    if (ties_bodies(loop)) loop = folded(loop, places);
  fold_forces(places, scene);
  for (MarkerSpec& marker : scene.markers) {
    const Place& place = places.of(marker.body);
    marker.body = place.carrier;
    marker.point = place.point(marker.point);
  }
  scene.visuals.clear();  // integrated scenes are not drawn
  std::erase_if(scene.held, [&](const std::string& joint) {
    return std::any_of(weld_of.begin(), weld_of.end(), [&](const auto& weld) {
      return weld.second == joint && !kept.contains(joint);
    });
  });
  for (const BodySpec& body : given.bodies) {
    if (places.carries(body.name)) continue;
    const Place& place = places.of(body.name);
    CarriedBody carried{body.name, place.carrier, Eigen::Isometry3d::Identity()};
    carried.pose.linear() = place.turn.toRotationMatrix();
    carried.pose.translation() = place.origin;
    result.carried.push_back(carried);
  }
  return result;
}

}  // namespace momenta
