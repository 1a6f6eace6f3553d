#pragma once
// Cost of the cuts of a mechanism, and which of two are better.

#include <momenta/dae/mechanism.h>

#include <cstdint>

namespace momenta {

struct CutCost {
  int open = 0;           ///< equations open at once, at most
  std::int64_t work = 0;  ///< LoopPlan::work: Σ over the fronts of their number squared
  /// Cost of an evaluation by the sweeps: `work`, and for each body and lane of the fronts
  /// (lanes_for) 4 in the plane and 15 in space.
  std::int64_t sweeps = 0;
  std::int64_t mass_entries = 0;    ///< upper triangle of M, one rate a body of the tree
  std::int64_t factor_entries = 0;  ///< L, where (7) is solved by the joints' sparse matrix
  int depth = 0;                    ///< depth of the tree, bodies
};

/// Cost of a mechanism's cuts. O(bodies + length of all loops).
CutCost cut_cost(const Mechanism& mechanism);

/// cut_cost() of a valid scene by the plan of another with the same bodies, L left out. Much
/// cheaper than making a Mechanism of it.
CutCost swept_cost(const Scene& scene, const Plan& plan);

/// Whether a costs less, or saves entries of M at next to no cost, as bodies nearer to the ground
/// gather less rounding: loops that close at the ground count there once more.
bool better(const CutCost& a, const CutCost& b);

}  // namespace momenta
