#pragma once
// Coordinates and rates of a joint from the motion of the two bodies it joins.

#include <momenta/core/poses.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/turned_round.h>

#include <vector>

namespace momenta {

struct JointMotion {
  std::vector<double> q, u;    ///< as JointSpec has them
  double shift = 0, tilt = 0;  ///< part of the pose that q does not give: [m], sine of an angle
};

/// @pre Not a user joint; a helical one as a hinge alone.
JointMotion joint_motion(const JointSpec& joint, const BodyMotion& parent, const BodyMotion& child);

}  // namespace momenta
