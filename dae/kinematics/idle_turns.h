#pragma once
// Freedoms on which nothing depends: a coupler with a ball at both ends spins about the line
// through them. Of J's ways at the start they are those in which balls alone turn, each about one
// line, and which a finite turn follows with loops closed.

#include <momenta/dae/kinematics/pose_curve.h>

#include <string>
#include <vector>

namespace momenta {

/// Starts the curve at the pose q, idle turns held as far as there are: false where more than one
/// freedom is left, or none. @param held names of the joints whose turn is held
bool start_without_idle_turns(PoseCurve& curve, double t, const Eigen::VectorXd& q,
                              CurvePoint& point, std::vector<std::string>& held);

}  // namespace momenta
