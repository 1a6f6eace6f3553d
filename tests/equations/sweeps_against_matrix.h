#pragma once
// Solutions by the sweeps against those of the assembled matrices, dense and sparse, at random
// states: momentum and acceleration form, ṗ, and the correction of positions.

#include "equations/random_tree.h"

#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/mechanism/mechanism.h>

namespace momenta::equations {

/// Momentum form, acceleration form and correction of positions at one state, with gauge and
/// feedback of their own.
struct Result {
  Eigen::VectorXd u, sigma, pdot, udot, lambda, delta;
};
Result solved(LoopSolver& solver, const Mechanism& mechanism, const TreeState& s,
              const Eigen::VectorXd& p, const Eigen::VectorXd& centre);

/// Largest differences over the growth that rounding must have, by what differs.
struct Worst {
  double u = 0, sigma = 0, pdot = 0, udot = 0, lambda = 0, delta = 0, sparse = 0;
  int tried = 0;  ///< carried by the sweeps
  int anew = 0;   ///< of these, with ties paired anew
};

/// One random state of `scene`, where it is well conditioned and has no more equations than rates.
void compare(const Scene& scene, RandomTree& random, const MechanismOptions& options, Worst& worst);

void expect_rounding(const Worst& worst, int bodies);

/// Batches of random states against the same states one by one, at every level; how many states
/// were compared.
int compare_batches(const Mechanism& mechanism, RandomTree& random, int count);

}  // namespace momenta::equations
