#include <momenta/core/scene/bearings_refused.h>

#include <algorithm>

namespace momenta {

const JointSpec* with_bearing(const Scene& scene) {
  const auto found = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [](const JointSpec& joint) { return joint.bearing.has_value(); });
  return found == scene.joints.end() ? nullptr : &*found;
}

void refuse_bearings(const Scene& scene, const std::string& what) {
  if (const JointSpec* joint = with_bearing(scene))
    throw SceneError(scene.where(joint->at) + "joint '" + joint->name +
                     "' has a bearing, whose friction follows from the joint's reaction: " + what +
                     " cannot take it, expected no bearing");
}

}  // namespace momenta
