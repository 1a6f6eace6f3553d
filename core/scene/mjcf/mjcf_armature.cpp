// `armature` a of ball and free joints: ½ a |ω|² of kinetic energy, and ½ a |v|² of a free joint,
// with ω the body's angular velocity against its parent and v the velocity of its point. On a fixed
// parent, ω is the body's own, and the same energy is that of the body with
//
//   I + a 1   about its centre of mass,    and, of a free joint, with a mass a at the point of v,
//
// whose weight a constant force −a g there cancels. On a moving parent no body has such an energy:
// there it becomes the joint's rotor_inertia.

#include <momenta/core/scene/mjcf/mjcf_inertia.h>
#include <momenta/core/scene/mjcf/mjcf_model.h>

#include <algorithm>

namespace momenta::reading {
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
