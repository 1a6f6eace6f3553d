#pragma once
// A platform on six rods or legs (platform_legs.h), as polynomials in Study's coordinates: its
// displacement D from the own pose as a dual quaternion e + ε g up to a factor (C. W. Wampler,
// Mech. Mach. Theory 31 (1996) 331-337). With R p = e p ē/(e·e) and the translation 2 g ē/(e·e), a
// rod of length l from b to the point at p in the own pose says
//
//   4 g·g + 4 g·(e p − b e) − 2 (b e)·(e p) + (p² + b² − l²) e·e = 0,      and  e·g = 0
//
// seven quadrics in the projective space of dimension 7. Solutions with e = 0 are no displacements:
// of the 2⁷ paths at most 40 end elsewhere, for six rods in general all 40 (F. Ronga, T. Vust 1992;
// M. Raghavan, J. Mech. Des. 115 (1993) 277-282).

#include <momenta/dae/kinematics/loop_polynomials.h>

namespace momenta {

/// @throws SceneError where platform_legs() would
std::unique_ptr<LoopPolynomials> platform_polynomials(const Mechanism& mechanism, double t,
                                                      const Eigen::VectorXd& own,
                                                      const std::vector<bool>& held);

}  // namespace momenta
