#pragma once
// The loops' multipliers that are unique at a state: found by the solver that gives them, at
// the cost of solving once more, and only where it has met rows that say nothing.
//
// Where Φ_q has lost rank, λ of (3) is determined but for ν with Φ_qᵀν = 0. A solver then gives the
// λ near a `centre` (kkt/kkt.h), and its weak pivots say nothing else: λ is affine in the centre,
// and
//
//   λ(c) − λ(0) = P c,   the range of P the space of ν.
//
// For all c but those of a set of measure zero a component of P c vanishes only if that row of P
// does, so one c taken at random tells: what does not move is unique.

#include <momenta/dae/kkt/loop_solver.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

class UniqueMultipliers {
 public:
  UniqueMultipliers(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver& solver);

  /// By row (m): whether the `lambda` (m) that `solver` has just found at (t, q, u), centred on
  /// zero, is unique. All false where the second solution fails. Cost: as of `lambda` where rows
  /// have faded, or where KLU, which can't tell, solves (7); else nothing.
  const std::vector<bool>& find(double t, const double* q, const double* u, const double* lambda);
  /// After find(): the difference of the two solutions (m), multipliers that move nothing; empty
  /// where all are unique or the second failed.
  const std::vector<double>& idle() const { return idle_; }

 private:
  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  LoopSolver& solver_;
  bool tells_;             ///< the solver knows when rows have faded
  Eigen::VectorXd units_;  ///< LoopUnits::equations (m)
  std::vector<double> direction_, centre_, moved_, udot_, idle_;
  std::vector<bool> unique_;
};

}  // namespace momenta
