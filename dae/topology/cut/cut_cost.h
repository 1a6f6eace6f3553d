#pragma once
// Graph of the trees on the ground, or of the children of a body (tree_order.h),
// numbered in the order of the scene; a loop that ties two is an edge.

#include <momenta/dae/mechanism/mechanism.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta {

class TieGraph {
 public:
  explicit TieGraph(std::size_t count = 0) : ties_(count) {}
  void tie(std::size_t a, std::size_t b);
  /// Sorts ties and drops repeated ones, after the last tie().
  void settle();

  std::size_t count() const { return ties_.size(); }
  const std::vector<std::size_t>& ties(std::size_t i) const { return ties_[i]; }
  /// Vertices tied to `first`, breadth first, those of few ties first.
  std::vector<std::size_t> breadth_first(std::size_t first) const;
  /// breadth_first() from an end: a vertex as far from another as that from it.
  std::vector<std::size_t> from_an_end(std::size_t any) const;

 private:
  std::vector<std::vector<std::size_t>> ties_;
};

// Cost of the cuts of a mechanism, and which of two are better.

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
