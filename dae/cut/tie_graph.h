#pragma once
// What stands side by side, numbered in the order of the scene, and which of them loops tie: the
// trees on the ground (root_order.h), or the children of a body (child_order.h).

#include <cstddef>
#include <vector>

namespace momenta {

class TieGraph {
 public:
  explicit TieGraph(std::size_t count = 0) : ties_(count) {}
  void tie(std::size_t a, std::size_t b);
  /// After the last tie(): each once, in order.
  void settle();

  std::size_t count() const { return ties_.size(); }
  const std::vector<std::size_t>& ties(std::size_t i) const { return ties_[i]; }
  /// All that is tied to `first`, breadth first, of few ties first.
  std::vector<std::size_t> breadth_first(std::size_t first) const;
  /// The same from an end: from one as far from another as that from it.
  std::vector<std::size_t> from_an_end(std::size_t any) const;

 private:
  std::vector<std::vector<std::size_t>> ties_;
};

}  // namespace momenta
