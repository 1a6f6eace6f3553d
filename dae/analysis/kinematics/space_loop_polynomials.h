#pragma once
// A single loop of six screws E₁ … E₆ = 1 (loop_screws.h) as polynomials: the inverse kinematics of
// a robot of six joints, linkages of seven hinges with one held, and loops of fewer freedoms.
//
// One half of the loop is x = A B C, the other the same x = A' B' C' (the three others inverse, in
// reverse), up to factors: a point of the projective space of dimension 7. With A = c + s L, (c, s)
// = u,
//
//   Ā(u) x is in the span of 1, L_B, L_C, L_B L_C       four equations, linear in u and in x
//
// and likewise for the other half, with v; or x C̄ is in the span of A and B. Ā x = α + β L_B + γ
// L_C + δ L_B L_C is a displacement B C if α δ = β γ: the same as Study's condition where the lines
// of B and C neither cross nor are parallel,
//
//   (Ā x)(Ā x)̄ = … + ε (α δ − β γ) 2 (m_B·l_C + l_B·m_C),
//
// and likewise for the other half. So there are nine equations in u, v and x, dimensions 1, 1 and
// 7, of Bézout number 4 · 4 · 2 = 32. Of the solutions 16 are no displacements: for z = c + i s = 0
// or w = c − i s = 0 Ā is a divisor of zero, Ā x = 0 for x of four dimensions, which meet the span
// of the other half at four values of v, and x x̄ = 0 there; likewise for v. The other 16 are those
// of six hinges in general (E. J. F. Primrose, Mech. Mach. Theory 21 (1986) 509-512; M. L. Husty,
// M. Pfurner, H.-P. Schröcker, Mech. Mach. Theory 42 (2007) 66-81). Slides have fewer.
//
// The halves, and the single screw in each, are chosen so that the lines of both pairs are as far
// from meeting as can be. Where one pair meets in any choice, its α δ = β γ replaces Study's
// condition: 40 paths, as it is zero twice where A is a divisor of zero.

#include <momenta/dae/analysis/kinematics/loop_polynomials.h>

namespace momenta {

/// @throws SceneError with the joint or loop that does not fit, or for more than six freedoms that
/// are not idle
std::unique_ptr<LoopPolynomials> space_loop_polynomials(const Mechanism& mechanism, double t,
                                                        const Eigen::VectorXd& own,
                                                        const std::vector<bool>& held);

}  // namespace momenta
