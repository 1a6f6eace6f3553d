#pragma once
// What redundant loop equations contradict each other by, because a file has rounded their numbers.
// In the units of an assembly, J = D⁻¹ Φ_q C and φ = D⁻¹ Φ, at a start that is closed (closing.h):
//
//   φ₀   is left of redundant equations, 10⁻⁶ at the most, no joint can close it further,
//   ς    is the largest singular value of J that does not count (loop_rank.h), over the largest.
//
// Of numbers that agree both are rounding. Of others ς is by how much equations that follow from
// the rest seem to be independent of it; away from the start φ − φ₀ grows by it. Along a motion
// both change: a hundredfold is allowed for. Whoever goes on from the start by Newton's steps asks
// here which pivots of J count and what of φ − φ₀ may stay open, and closes the others to rounding.

#include <momenta/dae/assembly/scaled_loops.h>

#include <Eigen/Core>

namespace momenta {

struct Contradiction {
  Eigen::VectorXd open;  ///< φ₀ (m); zero where all equations close
  double pivot = 0;      ///< pivots of J that count are above this part of the largest
  double left = 0;       ///< |φ − φ₀|∞ that redundant equations may have elsewhere
};

/// Of the rows and columns that are in, at a start q (nq) at t [s]; `pivot` is that of numbers that
/// agree. Cost: a singular value decomposition of J, a sparse QR of a large one.
Contradiction contradiction(ScaledLoops& loops, double t, const Eigen::VectorXd& q, double pivot);

}  // namespace momenta
