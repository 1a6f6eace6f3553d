#pragma once
// Where curves of poses cross. With U, V the singular vectors of J, ψ and T those of its k least
// singular values and of the k + 1 directions that remain, the poses near by that close all
// equations but ψᵀF are a patch over T, and on it
//
//   β(y) = ψᵀF,   ∂β/∂y = ψᵀ J T        (the reduced equations of Lyapunov and Schmidt)
//
// Curves cross where both vanish. Newton's method solves ∂β/∂y = 0, k (k + 1) equations for the k +
// 1 unknowns y, whose solution is regular although J is singular. β at its end tells crossing
// curves, β = 0, from those that pass each other like the branches of a hyperbola. Source:
// Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (2000), ch. 4, 7.

#include <momenta/dae/analysis/kinematics/pose_curve.h>

namespace momenta {

/// The change point nearest to a point of the curve, without tangent and orientation; false: none
/// near. Cost: some singular value decompositions of J.
bool change_point_near(PoseCurve& curve, const CurvePoint& near, CurvePoint& at);

/// Tangent at the change point `at`, straight across from `from`.
void go_straight_across(PoseCurve& curve, const CurvePoint& from, CurvePoint& at);

}  // namespace momenta
