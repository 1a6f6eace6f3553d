// Forces and limits at a joint of MJCF: spring, damper, friction, armature, limits. Hinges and
// slides: −k (q − springref) − c q̇, where the scene's q is the file's less `ref`. Ball and free
// joints: −k times the rotation vector (and displacement) from qpos0 and −c times all rates, a
// bushing. The `range` of a ball is 0 and the largest angle of its turn.

#include <momenta/core/format/mjcf/mjcf_inertia.h>
#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <numbers>

namespace momenta::reading {

namespace {

/// `limited` defaults to auto: a range limits, unless autolimits is false.
void read_limits(const Node& node, double unit, double ref, JointSpec& joint, MjcfModel& model) {
  constexpr std::array<std::string_view, 3> words{"auto", "false", "true"};
  const std::size_t limited = node.word("limited", words, 0);
  if (limited == 1 || (limited == 0 && !model.auto_limits) || !node.has("range")) return;
  const std::vector<double> range = node.numbers("range", 2);
  if (joint.kind == JointKind::free) return;
  if (joint.kind == JointKind::spherical) {  // angle of its turn; none beyond π
    const double most = unit * range[1];
    if (model.limits && most > 0 && most < std::numbers::pi) joint.limits = {0, most};
    return;
  }
  if (limited == 0 && range[0] == 0 && range[1] == 0) return;
  if (!(range[0] < range[1]))
    node.fail("range", "has its first number not below its second, expected limits of the joint");
  if (model.limits) joint.limits = {unit * range[0] - ref, unit * range[1] - ref};
}

}  // namespace

ForceSpec bushing_at(const JointSpec& joint) {
  ForceSpec f;
  f.at = joint.at;
  f.kind = "bushing";
  f.parent = joint.parent;
  f.child = joint.child;
  f.origin_parent = joint.origin_parent;
  f.origin_child = joint.origin_child;
  f.rotation = joint.rotation;
  if (joint.kind == JointKind::free) {
    const std::vector<double>& x = joint.position;
    f.origin_parent = {x[0], x[1], x[2]};
    f.rotation = Eigen::Quaterniond(x[3], x[4], x[5], x[6]);
  }
  return f;
}

void add_spring_and_damper(const JointSpec& joint, double stiffness, double damping,
                           MjcfModel& model) {
  if (stiffness == 0 && damping == 0) return;
  ForceSpec f = bushing_at(joint);
  f.rotational_stiffness = stiffness;
  f.rotational_damping = damping;
  if (joint.kind == JointKind::free) {
    f.stiffness = stiffness;
    f.damping = damping;
  }
  model.scene.forces.push_back(f);
}

void read_mechanics(const Node& node, JointSpec& joint, MjcfModel& model) {
  const bool one = has_one_coordinate(joint.kind);
  if (node.name() == "freejoint") return;
  if (has_axis(joint.kind)) joint.axis = node.direction("axis", Eigen::Vector3d::UnitZ());
  const double unit = joint.kind == JointKind::prismatic ? 1 : model.angles.unit;
  const double ref = one ? unit * node.number("ref", 0) : 0;
  if (ref != 0) model.refs[joint.name] = ref;
  const double rest = one ? unit * node.number("springref", 0) - ref : 0;
  if (rest != 0) model.rests[joint.name] = rest;
  read_limits(node, unit, ref, joint, model);
  if (node.has("actuatorfrcrange")) model.remarks.left_out("force ranges of actuators");
  const double stiffness = model.springs ? node.number("stiffness", 0) : 0,
               damping = model.dampers ? node.number("damping", 0) : 0,
               armature = node.number("armature", 0),
               friction = model.rubs ? node.number("frictionloss", 0) : 0;
  if (armature < 0) node.fail("armature", "is negative, expected a number >= 0");
  if (friction < 0) node.fail("frictionloss", "is negative, expected a number >= 0");
  if (node.has("springdamper")) {
    const std::vector<double> x = node.numbers("springdamper", 2);
    if (x[0] < 0 || x[1] < 0)
      node.fail("springdamper",
                "has a negative number, expected a time constant and a damping ratio > 0, or 0 for "
                "none");
    if (x[0] > 0 && x[1] > 0) model.spring_dampers.push_back({joint.name, x[0], x[1]});
  }
  if (!one) {
    if (friction != 0) model.remarks.left_out("friction of ball and free joints");
    if (armature != 0) model.ball_armatures.push_back({joint.name, armature});
    return add_spring_and_damper(joint, stiffness, damping, model);
  }
  joint.stiffness = stiffness;
  joint.damping = damping;
  if (stiffness != 0 || node.has("springdamper")) joint.rest = rest;
  if (armature > 0) joint.rotor_inertia = {armature};
  if (friction == 0) return;
  joint.friction = friction;
  model.remarks.count("taken as smooth friction: frictionloss of joints");
}

// `armature` a of ball and free joints: ½ a |ω|² of kinetic energy, and ½ a |v|² of a free joint,
// with ω the body's angular velocity against its parent and v the velocity of its point. On a fixed
// parent, ω is the body's own, and the same energy is that of the body with
//
//   I + a 1   about its centre of mass,    and, of a free joint, with a mass a at the point of v,
//
// whose weight a constant force −a g there cancels. On a moving parent no body has such an energy:
// there it becomes the joint's rotor_inertia.

namespace {

template <class All, class Named>
auto& named(All& all, const std::string& name, const Named& name_of) {
  return *std::find_if(all.begin(), all.end(), [&](const auto& x) { return name_of(x) == name; });
}

bool moves(const std::string& body, const Scene& scene) {
  std::string at = body;
  while (at != "ground") {
    const auto& joint = named(scene.joints, at, [](const JointSpec& j) { return j.child; });
    if (joint.kind != JointKind::weld) return true;
    at = joint.parent;
  }
  return false;
}

}  // namespace

void settle_ball_armatures(MjcfModel& model) {
  Scene& scene = model.scene;
  for (const auto& [name, a] : model.ball_armatures) {
    auto& joint = named(scene.joints, name, [](const JointSpec& j) { return j.name; });
    BodySpec& body = named(scene.bodies, joint.child, [](const BodySpec& b) { return b.name; });
    if (joint.kind == JointKind::spherical && (moves(joint.parent, scene) || body.mass == 0)) {
      joint.rotor_inertia = {a};
      continue;
    }
    MjcfInertia sum{body.mass, body.com, body.inertia};
    sum.inertia += a * Eigen::Matrix3d::Identity();
    if (joint.kind == JointKind::free) {
      sum.add({a, joint.origin_child, Eigen::Matrix3d::Zero()});
      take_back_weight(body.name, joint.origin_child, a, joint.at, scene);
    }
    body.mass = sum.mass;
    body.com = sum.com;
    body.inertia = sum.inertia;
    model.remarks.count("taken as inertia of their bodies: armature of ball and free joints");
  }
}

}  // namespace momenta::reading
