#pragma once
// Coordinates and rates of a joint from the motion of the two bodies it joins.

#include <momenta/core/poses.h>
#include <momenta/core/scene/scene.h>

#include <vector>

namespace momenta {

struct JointMotion {
  std::vector<double> q, u;    ///< as JointSpec has them
  double shift = 0, tilt = 0;  ///< what the joint's q leave of the pose: [m], sine of an angle
};

/// @pre Not a user joint; a helical one as a hinge alone.
JointMotion joint_motion(const JointSpec& joint, const BodyMotion& parent, const BodyMotion& child);

/// The joint seen from its child: the same q and u of kinds with one axis and of welds; of a
/// universal joint its two coordinates have changed places. Of others q and u are others: theirs
/// are left empty.
JointSpec turned_round(const JointSpec& joint);
/// Whether q and u of a joint mean the same, but for their order, once it is turned round.
bool keeps_coordinates(JointKind kind);

}  // namespace momenta
