#pragma once
// Graph of the trees on the ground (root_order.h), or of the children of a body (child_order.h),
// numbered in the order of the scene; a loop that ties two is an edge.

#include <cstddef>
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

}  // namespace momenta
