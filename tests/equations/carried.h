#pragma once
// A mechanism put on a body of its own, "base", so that its plane goes where that body goes.

#include <momenta/core/scene/scene.h>

#include <string>
#include <utility>
#include <vector>

#include "equations/parts.h"

namespace momenta::equations {

/// What stood on the ground stands on the base, which the last of `joints` carries; `bodies`: those
/// that the joints before it carry, and the base.
inline Scene on_base(Scene scene, std::vector<BodySpec> bodies, std::vector<JointSpec> joints) {
  const auto carried = [](std::string& body) {
    if (body == "ground") body = "base";
  };
  for (JointSpec& joint : scene.joints) carried(joint.parent);
  for (LoopSpec& loop : scene.loops)
    if (ties_bodies(loop)) carried(loop.parent), carried(loop.child);
  for (ForceSpec& force : scene.forces) carried(force.parent), carried(force.child);
  for (MarkerSpec& marker : scene.markers) carried(marker.body);
  scene.bodies.insert(scene.bodies.begin(), bodies.begin(), bodies.end());
  scene.joints.insert(scene.joints.begin(), joints.begin(), joints.end());
  return scene;
}

inline BodySpec massless(const std::string& name) {
  BodySpec body;
  body.name = name;
  return body;
}
inline JointSpec base_joint(const std::string& name, JointKind kind, const std::string& parent,
                            const std::string& child, const Eigen::Vector3d& axis) {
  return make_joint(kind, name, parent, child, {0, 0, 0}, axis);
}

}  // namespace momenta::equations
