#pragma once
// Equations that are redundant, or that lose rank at a pose because it is stretched: rods in one
// line, a dead point.
//
// Let rows D of J follow from the others at q. Along a motion δ of the others' null space, with the
// others held closed, Φ_D of redundant rows stays what it is: what their numbers contradict each
// other by. At a stretched pose it changes with the square of the way,
//
//   Φ_D(s δ) = Φ_D(0) + κ s² / 2 + …,
//
// and where κ and Φ_D(0) have opposite signs the loops close at s = √(−2 Φ_D(0) / κ), else they are
// too short by Φ_D(0), whatever moves. Motions are random, for κ of single ones may be zero.

#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <vector>

namespace momenta {

struct Bending {
  bool bends = false;   ///< some Φ_D changes: the pose is stretched, the rows are not redundant
  bool closes = false;  ///< Φ_D shrinks in some direction
  std::vector<Eigen::VectorXd> nearer;  ///< poses there, nearly closed: starts for Newton's method
};

/// At q and time t [s], where J Jᵀ Φ is about zero. D: rows dependent at q; where there are none,
/// that of the largest Φ. `tolerance` of |Φ|∞, in units. Places the evaluation at q. Cost: some 30
/// least-norm factorisations.
Bending bending(ScaledLoops& loops, LeastNorm& steps, double t, const Eigen::VectorXd& q,
                double tolerance);

}  // namespace momenta
