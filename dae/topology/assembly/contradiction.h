#pragma once
// Contradictions between redundant loop equations whose numbers a file has rounded.
// In the units of an assembly, J = D⁻¹ Φ_q C and φ = D⁻¹ Φ, at a start that is closed (closing.h):
//
//   φ₀   is left of redundant equations, 10⁻⁶ at the most, no joint can close it further,
//   ς    is the largest singular value of J that does not count (loop_rank.h), over the largest.
//
// Where numbers agree both are rounding. Else ς tells how independent dependent equations seem;
// away from the start φ − φ₀ grows by it. Along a motion both change: a hundredfold is allowed for.
// Newton's method from the start learns here which pivots of J count and what of φ − φ₀ may stay
// open, and closes the others to rounding.

#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <Eigen/Core>

namespace momenta {

struct Contradiction {
  Eigen::VectorXd open;  ///< φ₀ (m); zero where all equations close
  double pivot = 0;      ///< pivots of J that count are above this part of the largest
  double left = 0;       ///< |φ − φ₀|∞ that redundant equations may have elsewhere
};

/// Contradiction of the rows and columns in use, at a start q (nq) at t [s]; `pivot`: for numbers
/// that agree. Cost: a singular value decomposition of J, a sparse QR of a large one.
Contradiction contradiction(ScaledLoops& loops, double t, const Eigen::VectorXd& q, double pivot);

}  // namespace momenta
