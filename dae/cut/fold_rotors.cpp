#include <momenta/core/scene/validate.h>
#include <momenta/dae/cut/fold_rotors.h>
#include <momenta/dae/cut/fold_welds.h>
#include <momenta/dae/cut/merged_body.h>

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_map>

namespace momenta {
namespace {

using Eigen::Vector3d;

/// Whether the centre of mass is on the axis of the joint, but for rounding.
bool balanced(const JointSpec& joint, const BodySpec& body) {
  constexpr double rounding = 1e-14;
  const double across = joint.axis.normalized().cross(body.com - joint.origin_child).norm();
  return body.mass == 0 || across <= rounding * (body.com.norm() + joint.origin_child.norm());
}

/// A coupler by which one joint follows another: q = ratio q' + offset.
struct Gear {
  std::size_t coupler = 0, leader = 0;
  int coordinate = 0;  ///< of the leader
  double ratio = 0, offset = 0;
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
      if (loop.kind != LoopKind::coupler) tied_.insert({loop.parent, loop.child});
    }
    for (std::size_t i = 0; i < s.forces.size(); ++i) {
      const ForceSpec& force = s.forces[i];
      if (force.kind == "torque")
        torques_[joints_.at(force.joint)].push_back(i);
      else
        tied_.insert({force.parent, force.child, force.body});
    }
    for (const DriveSpec& drive : s.drives) driven_.insert({drive.joint, drive.loop});
  }

  FoldedScene fold() {
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < result_.scene.joints.size(); ++i) pending.push_back(i);
    while (!pending.empty()) {
      const std::size_t joint = pending.back();
      pending.pop_back();
      const auto gear = gear_of(joint);
      if (!gear || !can_take(gear->leader, joint, gear->ratio)) continue;
      take(joint, *gear);
      pending.push_back(gear->leader);  // in one coupler less, it may be a rotor's itself
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
        driven_.contains(j.name) || turns(j.parent) || !balanced(j, body(j.child)))
      return std::nullopt;
    const std::size_t coupler = couplers_[i].front();
    const LoopSpec& loop = result_.scene.loops[coupler];
    if (loop.joints.size() != 2 || driven_.contains(loop.name)) return std::nullopt;
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
    const Vector3d axis = j.axis.normalized();
    const double moment = axis.dot(rotor.inertia * axis);
    leader.rotor_inertia.resize(rotors_of(leader.kind));
    leader.rotor_inertia[static_cast<std::size_t>(gear.coordinate)] +=
        (moment + (j.rotor_inertia.empty() ? 0 : j.rotor_inertia[0])) * squared;
    leader.damping += j.damping * squared;
    if (j.stiffness != 0) {
      const double own = leader.stiffness, taken = j.stiffness * squared;
      leader.stiffness += taken;
      leader.rest =
          (own * leader.rest + taken * (j.rest - gear.offset) / gear.ratio) / leader.stiffness;
    }
    for (const std::size_t k : torques_[i]) {
      ForceSpec& torque = result_.scene.forces[k];
      torque.joint = leader.name;
      torque.value *= gear.ratio;
      torques_[gear.leader].push_back(k);
    }
    if (j.parent != "ground") {
      // as at angle zero: its mass is on the axis, and what carries it does not turn
      const Eigen::Quaterniond turn = j.rotation.normalized();
      BodySpec& carrier = body(j.parent);
      carrier = merged_body(carrier, rotor, turn, j.origin_parent - turn * j.origin_child);
    }
    if (leaders_.contains(j.name))
      for (FollowingJoint& f : result_.following)
        if (f.leader == j.name) follow(f, leader, gear);
    leaders_.insert(leader.name);
    FollowingJoint following;
    following.joint = j.name;
    following.body = rotor.name;
    following.ratio = 1;
    following.inertia = moment;
    follow(following, leader, gear);
    result_.following.push_back(following);
    std::erase(couplers_[gear.leader], gear.coupler);
    couplers_[i].clear();
    gone_.insert({j.name, result_.scene.loops[gear.coupler].name});
    gone_bodies_.insert(rotor.name);
  }

  /// What followed a joint that follows by `gear` follows its leader.
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
    std::erase_if(s.joints, went);
    std::erase_if(s.loops, went);
    std::erase_if(s.bodies, [&](const BodySpec& b) { return gone_bodies_.contains(b.name); });
    std::erase_if(s.markers, [&](const MarkerSpec& m) { return gone_bodies_.contains(m.body); });
    std::erase_if(s.held, [&](const std::string& name) { return gone_.contains(name); });
  }

  FoldedScene result_;
  std::unordered_map<std::string, std::size_t> bodies_, joints_, inward_;  // places, by names
  std::unordered_map<std::string, bool> turns_;
  std::vector<std::vector<std::size_t>> couplers_, torques_;  // of each joint
  std::set<std::string> tied_;    // bodies with children, loops, springs or wrenches
  std::set<std::string> driven_;  // joints and loops
  std::set<std::string> gone_;    // joints and loops
  std::set<std::string> gone_bodies_, leaders_;
};

}  // namespace

FoldedScene fold_rotors(const Scene& scene) {
  validate(scene);
  return RotorFold(scene).fold();
}

FoldedScene fold(const Scene& scene) {
  FoldedScene welds = fold_welds(scene), rotors = fold_rotors(welds.scene);
  rotors.carried = std::move(welds.carried);
  return rotors;
}

}  // namespace momenta
