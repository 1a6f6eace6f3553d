#include <momenta/dae/cut/tie_graph.h>

#include <algorithm>

namespace momenta {

void TieGraph::tie(std::size_t a, std::size_t b) {
  if (a == b) return;
  ties_[a].push_back(b);
  ties_[b].push_back(a);
}

void TieGraph::settle() {
  for (auto& list : ties_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

std::vector<std::size_t> TieGraph::breadth_first(std::size_t first) const {
  std::vector<char> seen(count(), 0);
  std::vector<std::size_t> reached{first};
  seen[first] = 1;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    std::vector<std::size_t> next;
    for (const std::size_t one : ties(reached[i]))
      if (!seen[one]) next.push_back(one);
    std::stable_sort(next.begin(), next.end(),
                     [&](std::size_t a, std::size_t b) { return ties(a).size() < ties(b).size(); });
    for (const std::size_t one : next) seen[one] = 1;
    reached.insert(reached.end(), next.begin(), next.end());
  }
  return reached;
}

std::vector<std::size_t> TieGraph::from_an_end(std::size_t any) const {
  return breadth_first(breadth_first(breadth_first(any).back()).back());
}

}  // namespace momenta
