#pragma once
// Loops in a plane as polynomials, in isotropic coordinates (C. W. Wampler, ASME J. Mech. Des. 121
// (1999) 382-387).
//
// A vector of the plane is a complex number. A body is turned from the own pose by z = e^{iφ}; w =
// e^{−iφ}, so that z w = 1. Its origin lies at
//
//   O = O_parent + z_parent (r + s e)      r: in the own pose, e: direction of a slide, s: its way
//
// and at Ō with w in place of z and conjugate constants: O and Ō, z and w are independent. With D =
// O_A + z_A a − O_B − z_B b
//
//   point, revolute, spherical   D = 0,  D̄ = 0
//   weld                         the same, and z_A = z_B
//   prismatic, slot on a line    D̄ e z_B − D ē w_B = 0;  z_A = z_B of the former
//   distance                     D D̄ = l²
//
// a driven slide is a pair of points, a driven angle z_A = z_B. Bodies of one angle have one z. Two
// slides in a row on a body that does not turn are one X = s₁ e₁ + s₂ e₂ and X̄. Groups: all z and
// X, all w and X̄, each s. With N angles in L loops of hinges the Bézout number is the binomial (2L
// over L): 2, 6, 20. A solution is real where w = z̄, X̄ the conjugate of X, s real.

#include <momenta/dae/analysis/kinematics/loop_polynomials.h>

namespace momenta {

/// @throws SceneError for couplers, curves, equations, screws, and redundant loop equations
std::unique_ptr<LoopPolynomials> planar_polynomials(const Mechanism& mechanism, double t,
                                                    const Eigen::VectorXd& own,
                                                    const std::vector<bool>& held);

}  // namespace momenta
