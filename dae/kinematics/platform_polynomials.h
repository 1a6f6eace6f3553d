#pragma once
// A body on six rods with balls at their ends, as polynomials in Study's coordinates: its
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

/// Whether all that moves is one free body, none of it held, on six loops of kind distance from
/// what stands.
bool is_platform(const Mechanism& mechanism, const std::vector<bool>& held);

/// @pre is_platform()
std::unique_ptr<LoopPolynomials> platform_polynomials(const Mechanism& mechanism, double t,
                                                      const Eigen::VectorXd& own);

}  // namespace momenta
