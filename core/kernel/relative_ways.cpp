#include <momenta/core/kernel/relative_ways.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace momenta {
namespace {

std::size_t at(int body) {
  return static_cast<std::size_t>(body);
}

}  // namespace

RelativeWays::RelativeWays(std::vector<int> parents)
    : parents_(std::move(parents)), ends_(parents_.size()), found_(parents_.size(), OnWay::no) {
  std::iota(ends_.begin(), ends_.end(), 0);
}

void RelativeWays::up(int from, int ancestor) {
  if (from < 0) return;
  ends_[at(from)] = std::min(ends_[at(from)], ancestor);
  if (ancestor >= 0) found_[at(ancestor)] = OnWay::at_rest;
}

void RelativeWays::between(int a, int b) {
  int x = a, y = b;
  // Depth-first: the later body is no ancestor of the earlier one; climb from it.
  while (x != y) {
    int& later = x > y ? x : y;
    later = parents_[at(later)];
  }
  up(a, x);
  up(b, x);
}

std::vector<OnWay> RelativeWays::found() const {
  std::vector<int> ends = ends_;
  std::vector<OnWay> found = found_;
  for (std::size_t k = ends.size(); k-- > 0;) {
    if (ends[k] == static_cast<int>(k)) continue;
    found[k] = OnWay::moved;
    if (const int parent = parents_[k]; parent >= 0)
      ends[at(parent)] = std::min(ends[at(parent)], ends[k]);
  }
  return found;
}

}  // namespace momenta
