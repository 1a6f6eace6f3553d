#pragma once
// Where the smallest pivot of B is least between two points of a curve of poses, by the golden
// section: zero at a change point.

#include <momenta/dae/kinematics/pose_curve.h>

namespace momenta {

/// On the way of this length along τ of `from`; `first` where no point there has a smaller one.
CurvePoint least_pivot(PoseCurve& curve, const CurvePoint& from, double length,
                       const CurvePoint& first);

}  // namespace momenta
