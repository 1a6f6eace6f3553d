#pragma once
// A platform on six rods. Two pieces of a mechanism (pieces.h) are special: the base, with the
// ground, and the platform, with the most ties. Chains of ties connect them, each a loop of kind
// distance or a leg with the same effect (platform_rod.h).

#include <momenta/dae/analysis/kinematics/loop_polynomials.h>
#include <momenta/dae/analysis/kinematics/platform_rod.h>

#include <vector>

namespace momenta {

struct PlatformLegs {
  int platform = -1;
  std::vector<PlatformRod> rods;  ///< six chains of ties of the pieces
};

/// @throws SceneError with the joint, loop or body that does not fit
PlatformLegs platform_legs(const Mechanism& mechanism, const Pieces& pieces);

// A platform on six rods or legs (platform_polynomials.h), as polynomials in Study's coordinates:
// its displacement D from the own pose as a dual quaternion e + ε g up to a factor (C. W. Wampler,
// Mech. Mach. Theory 31 (1996) 331-337). With R p = e p ē/(e·e) and the translation 2 g ē/(e·e), a
// rod of length l from b to the point at p in the own pose says
//
//   4 g·g + 4 g·(e p − b e) − 2 (b e)·(e p) + (p² + b² − l²) e·e = 0,      and  e·g = 0
//
// seven quadrics in the projective space of dimension 7. Solutions with e = 0 are no displacements:
// of the 2⁷ paths at most 40 end elsewhere, for six rods in general all 40 (F. Ronga, T. Vust 1992;
// M. Raghavan, J. Mech. Des. 115 (1993) 277-282).

/// @throws SceneError where platform_legs() would
std::unique_ptr<LoopPolynomials> platform_polynomials(const Mechanism& mechanism, double t,
                                                      const Eigen::VectorXd& own,
                                                      const std::vector<bool>& held);

}  // namespace momenta
