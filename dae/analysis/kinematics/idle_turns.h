#pragma once
// Idle freedoms: a coupler with a ball at both ends spins about the line through them. In J's null
// space at the start, these are directions in which balls alone turn, each about one line, and
// which a finite turn follows with loops closed.

#include <momenta/dae/analysis/kinematics/pose_curve.h>

#include <string>
#include <vector>

namespace momenta {

/// Starts the curve at the pose q with all idle turns held; false: not one freedom is left. @param
/// held names of their joints
bool start_without_idle_turns(PoseCurve& curve, double t, const Eigen::VectorXd& q,
                              CurvePoint& point, std::vector<std::string>& held);

}  // namespace momenta
