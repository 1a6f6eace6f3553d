#pragma once
// What the cuts of a mechanism cost, and which of two are better.

#include <momenta/dae/mechanism.h>

#include <cstdint>

namespace momenta {

struct CutCost {
  int open = 0;           ///< equations open at once, at most
  std::int64_t work = 0;  ///< LoopPlan::work: Σ over the fronts of their number squared
  /// What an evaluation by the sweeps costs, in the units of `work`: that, and for each body and
  /// lane of the fronts (lanes_for) 4 in the plane and 15 in space.
  std::int64_t sweeps = 0;
  std::int64_t mass_entries = 0;    ///< of M, upper triangle, one rate a body of the tree
  std::int64_t factor_entries = 0;  ///< of L, where (7) is solved by the joints' sparse matrix
  int depth = 0;                    ///< of the tree, bodies
};

/// How the loops of a mechanism lie in its tree. O(bodies + length of all loops).
CutCost cut_cost(const Mechanism& mechanism);

/// The same of a valid scene by the plan of another with the same bodies, L left out. Much cheaper
/// than to make a Mechanism of it.
CutCost swept_cost(const Scene& scene, const Plan& plan);

/// Less cost; or entries of M saved at next to none, as bodies nearer to the ground gather less
/// rounding: loops that close at the ground count there once more.
bool better(const CutCost& a, const CutCost& b);

}  // namespace momenta
