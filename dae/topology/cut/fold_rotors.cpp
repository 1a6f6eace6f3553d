#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/validate.h>
#include <momenta/dae/topology/cut/fold_rotors.h>
#include <momenta/dae/topology/cut/fold_welds.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>
#include <set>
#include <unordered_map>

namespace momenta {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double rounding = 1e-14;

/// Whether the centre of mass is on the axis of the joint, but for rounding.
bool balanced(const JointSpec& joint, const BodySpec& body) {
  const double across = joint.axis.normalized().cross(body.com - joint.origin_child).norm();
  return body.mass == 0 || across <= rounding * (body.com.norm() + joint.origin_child.norm());
}

/// Whether the body's inertia is the same however it is turned about the joint, but for rounding.
bool symmetric(const JointSpec& joint, const BodySpec& body) {
  const Vector3d a = joint.axis.normalized(), x = perpendicular_to(a), y = a.cross(x);
  const Matrix3d& I = body.inertia;
  const double most = std::max({std::abs(a.dot(I * x)), std::abs(a.dot(I * y)),
                                std::abs(x.dot(I * y)), std::abs(x.dot(I * x) - y.dot(I * y))});
  return most <= rounding * I.trace();
}

Vector3d axis_in_parent(const JointSpec& joint) {
  return joint.rotation.normalized() * joint.axis.normalized();
}

/// Whether a coordinate of a joint is all its child turns by, about its axis.
bool turns_about_axis(const JointSpec& joint, int coordinate) {
  return joint.kind == JointKind::revolute || joint.kind == JointKind::helical ||
         (joint.kind == JointKind::cylindrical && coordinate == 1) ||
         (joint.kind == JointKind::planar && coordinate == 2);
}

/// A coupler by which one joint follows another, q = ratio q' + offset, and K of (*).
struct Gear {
  std::size_t coupler = 0, leader = 0;
  int coordinate = 0;  ///< coordinate of the leader
  double ratio = 0, offset = 0;
  double shifted = 0;         ///< K [kg m²]
  std::string to = "ground";  ///< the other body of the leader
  Vector3d axis = Vector3d::Zero(), axis_there = Vector3d::Zero();  ///< in axes of B, of the other
};

class RotorFold {
 public:
  explicit RotorFold(const Scene& given) {
    result_.scene = given;
    const Scene& s = result_.scene;
    for (std::size_t i = 0; i < s.bodies.size(); ++i) bodies_[s.bodies[i].name] = i;
    for (std::size_t i = 0; i < s.joints.size(); ++i) {
      joints_[s.joints[i].name] = i;
      inward_[s.joints[i].child] = i;
      tied_.insert(s.joints[i].parent);
    }
    couplers_.resize(s.joints.size());
    torques_.resize(s.joints.size());
    for (std::size_t i = 0; i < s.loops.size(); ++i) {
      const LoopSpec& loop = s.loops[i];
      for (const std::string& joint : loop.joints) couplers_[joints_.at(joint)].push_back(i);
      if (ties_bodies(loop)) tied_.insert({loop.parent, loop.child});
    }
    for (std::size_t i = 0; i < s.forces.size(); ++i) {
      const ForceSpec& force = s.forces[i];
      if (force.kind == "torque" && force.law.empty())
        torques_[joints_.at(force.joint)].push_back(i);
      else if (force.kind == "coordinate-spring")
        sprung_.insert(force.joints.begin(), force.joints.end());
      else
        tied_.insert({force.parent, force.child, force.body});
    }
    const NamedInFormulas named(s);
    sprung_.insert(named.joints.begin(), named.joints.end());
    tied_.insert(named.bodies.begin(), named.bodies.end());
    for (const DriveSpec& drive : s.drives) driven_.insert({drive.joint, drive.loop});
  }

  FoldedScene fold() {
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < result_.scene.joints.size(); ++i) pending.push_back(i);
    while (!pending.empty()) {
      const std::size_t joint = pending.back();
      pending.pop_back();
      auto gear = gear_of(joint);
      if (!gear || !can_shift(joint, *gear) || !can_take(gear->leader, joint, gear->ratio))
        continue;
      take(joint, *gear);
      pending.push_back(gear->leader);  // in one coupler less, it may be a rotor's joint itself
    }
    drop_what_went();
    return std::move(result_);
  }

 private:
  JointSpec& joint(std::size_t i) { return result_.scene.joints[i]; }
  BodySpec& body(const std::string& name) { return result_.scene.bodies[bodies_.at(name)]; }

  /// Whether a body can have an angular velocity. O(1) amortised
  bool turns(const std::string& name) {
    std::vector<std::string> way;
    bool answer = false;
    for (std::string b = name; b != "ground";) {
      if (const auto known = turns_.find(b); known != turns_.end()) {
        answer = known->second;
        break;
      }
      way.push_back(b);
      const JointSpec& inward = joint(inward_.at(b));
      answer = inward.kind != JointKind::prismatic && inward.kind != JointKind::weld;
      if (answer) break;
      b = inward.parent;
    }
    for (const std::string& b : way) turns_[b] = answer;
    return answer;
  }

  /// The one coupler that a rotor's joint follows; nothing where the joint is no rotor's.
  std::optional<Gear> gear_of(std::size_t i) {
    const JointSpec& j = joint(i);
    if (j.kind != JointKind::revolute || couplers_[i].size() != 1 || tied_.contains(j.child) ||
        driven_.contains(j.name) || j.friction != 0 || j.bearing || has_stops(j) ||
        sprung_.contains(j.name) || !balanced(j, body(j.child)))
      return std::nullopt;
    const std::size_t coupler = couplers_[i].front();
    const LoopSpec& loop = result_.scene.loops[coupler];
    if (loop.joints.size() != 2 || has_powers(loop) || driven_.contains(loop.name))
      return std::nullopt;
    const std::size_t own = loop.joints[0] == j.name ? 0 : 1, other = 1 - own;
    if (loop.joints[other] == j.name) return std::nullopt;
    Gear gear;
    gear.coupler = coupler;
    gear.leader = joints_.at(loop.joints[other]);
    gear.coordinate = loop.coordinates.empty() ? 0 : loop.coordinates[other];
    gear.ratio = -loop.ratios[other] / loop.ratios[own];
    gear.offset = loop.offset / loop.ratios[own];
    return gear;
  }

  /// Finds K; false where the rotor's carrier turns and (*) does not hold.
  bool can_shift(std::size_t i, Gear& gear) {
    const JointSpec &j = joint(i), &leader = joint(gear.leader);
    const BodySpec& rotor = body(j.child);
    if (!turns(j.parent)) return true;
    constexpr double parallel = 1e-12;
    const bool outer = leader.child == j.parent;
    if ((!outer && leader.parent != j.parent) || !symmetric(j, rotor) ||
        !turns_about_axis(leader, gear.coordinate))
      return false;
    gear.to = outer ? leader.parent : leader.child;
    gear.axis = axis_in_parent(j);
    const Vector3d inner_axis = axis_in_parent(leader), outer_axis = leader.axis.normalized();
    gear.axis_there = outer ? inner_axis : outer_axis;
    const Vector3d& other = outer ? outer_axis : inner_axis;
    if (gear.axis.cross(other).norm() > parallel) return false;
    const double sense = (gear.axis.dot(other) > 0 ? 1 : -1) * (outer ? -1 : 1);
    gear.shifted = sense * gear.ratio * axial(j, rotor);
    // I_r, then the inertia left to the body that gives
    if (sense * gear.ratio > 0 && sense * gear.ratio < 1) return false;
    if (gear.shifted > 0)
      return is_inertia(carrier_of(i).inertia - moment(gear.shifted, gear.axis));
    return gear.to == "ground" ||
           is_inertia(body(gear.to).inertia + moment(gear.shifted, gear.axis_there));
  }

  static double axial(const JointSpec& joint, const BodySpec& rotor) {
    const Vector3d axis = joint.axis.normalized();
    return axis.dot(rotor.inertia * axis);
  }
  static Matrix3d moment(double about, const Vector3d& axis) {
    return about * axis * axis.transpose();
  }
  static bool is_inertia(const Matrix3d& m) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(m, Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[0] >= -rounding * solver.eigenvalues()[2];
  }

  /// The body that carries a rotor, with the rotor fixed to it as at angle zero.
  BodySpec carrier_of(std::size_t i) {
    const JointSpec& j = joint(i);
    const Eigen::Quaterniond turn = j.rotation.normalized();
    return merged_body(body(j.parent), body(j.child), turn,
                       j.origin_parent - turn * j.origin_child);
  }

  /// Whether the leader can take the forces along the rotor's joint.
  bool can_take(std::size_t leader, std::size_t i, double ratio) {
    const JointSpec &j = joint(i), &l = joint(leader);
    if (j.stiffness == 0 && j.damping == 0 && torques_[i].empty()) return true;
    // springs that cancel have no rest
    return has_one_coordinate(l.kind) && !driven_.contains(l.name) &&
           (j.stiffness == 0 || l.stiffness + j.stiffness * ratio * ratio != 0);
  }

  void take(std::size_t i, const Gear& gear) {
    JointSpec &j = joint(i), &leader = joint(gear.leader);
    const BodySpec& rotor = body(j.child);
    const double squared = gear.ratio * gear.ratio;
    const double own = axial(j, rotor);
    const double armature = j.rotor_inertia.empty() ? 0 : j.rotor_inertia[0];
    leader.rotor_inertia.resize(rotors_of(leader.kind));
    leader.rotor_inertia[static_cast<std::size_t>(gear.coordinate)] +=
        std::max(own * squared - gear.shifted, 0.0) + armature * squared;
    leader.damping += j.damping * squared;
    if (j.stiffness != 0) {
      const double before = leader.stiffness, taken = j.stiffness * squared;
      leader.stiffness += taken;
      leader.rest =
          (before * leader.rest + taken * (j.rest - gear.offset) / gear.ratio) / leader.stiffness;
    }
    for (const std::size_t k : torques_[i]) {
      ForceSpec& torque = result_.scene.forces[k];
      torque.joint = leader.name;
      torque.value *= gear.ratio;
      torques_[gear.leader].push_back(k);
    }
    if (j.parent != "ground") {
      body(j.parent) = carrier_of(i);
      shift(body(j.parent), -gear.shifted, gear.axis);
    }
    if (gear.to != "ground") shift(body(gear.to), gear.shifted, gear.axis_there);
    if (leaders_.contains(j.name))
      for (FollowingJoint& f : result_.following)
        if (f.leader == j.name) follow(f, leader, gear);
    leaders_.insert(leader.name);
    FollowingJoint following;
    following.joint = j.name;
    following.body = rotor.name;
    following.ratio = 1;
    following.inertia = own;
    follow(following, leader, gear);
    result_.following.push_back(following);
    std::erase(couplers_[gear.leader], gear.coupler);
    couplers_[i].clear();
    gone_.insert({j.name, result_.scene.loops[gear.coupler].name});
    gone_bodies_.insert(rotor.name);
  }

  static void shift(BodySpec& body, double about, const Vector3d& axis) {
    if (about == 0) return;
    body.inertia += moment(about, axis);
    body.any_inertia = true;
  }

  /// Makes f, which follows a joint that follows by `gear`, follow that joint's leader.
  static void follow(FollowingJoint& f, const JointSpec& leader, const Gear& gear) {
    f.leader = leader.name;
    f.coordinate = gear.coordinate;
    f.offset += f.ratio * gear.offset;
    f.ratio *= gear.ratio;
    f.inertia *= gear.ratio * gear.ratio;
    f.slides = leader.kind == JointKind::prismatic ||
               (leader.kind == JointKind::cylindrical && gear.coordinate == 0) ||
               (leader.kind == JointKind::planar && gear.coordinate < 2);
  }

  void drop_what_went() {
    Scene& s = result_.scene;
    const auto went = [&](const auto& x) { return gone_.contains(x.name); };
    std::sort(result_.following.begin(), result_.following.end(),
              [&](const FollowingJoint& a, const FollowingJoint& b) {
                return joints_.at(a.joint) < joints_.at(b.joint);
              });
    std::erase_if(s.joints, went);
    std::erase_if(s.loops, went);
    std::erase_if(s.bodies, [&](const BodySpec& b) { return gone_bodies_.contains(b.name); });
    std::erase_if(s.markers, [&](const MarkerSpec& m) { return gone_bodies_.contains(m.body); });
    s.visuals.clear();  // integrated scenes are not drawn
    std::erase_if(s.held, [&](const std::string& name) { return gone_.contains(name); });
  }

  FoldedScene result_;
  std::unordered_map<std::string, std::size_t> bodies_, joints_, inward_;  // places, by names
  std::unordered_map<std::string, bool> turns_;
  std::vector<std::vector<std::size_t>> couplers_, torques_;  // by joint
  std::set<std::string> tied_;    // bodies with children, loops, springs or wrenches
  std::set<std::string> driven_;  // joints and loops
  std::set<std::string> sprung_;  // joints that coordinate springs and formulas name
  std::set<std::string> gone_;    // joints and loops
  std::set<std::string> gone_bodies_, leaders_;
};

}  // namespace

FoldedScene fold_rotors(const Scene& scene) {
  validate(scene);
  const bool couples = std::any_of(scene.loops.begin(), scene.loops.end(),
                                   [](const LoopSpec& l) { return l.kind == LoopKind::coupler; });
  if (!couples) return {scene, {}, {}};
  return RotorFold(scene).fold();
}

FoldedScene fold(const Scene& scene) {
  FoldedScene welds = fold_welds(scene), rotors = fold_rotors(welds.scene);
  rotors.carried = std::move(welds.carried);
  return rotors;
}

}  // namespace momenta
