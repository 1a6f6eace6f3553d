#pragma once
// Marks of children, alike for both kinds of link trees.

#include <cstddef>
#include <vector>

namespace momenta {

/// Marks the child of each slot that the inward sweep meets first: it opens the slot, the others
/// add. O(links).
template <class Links>
void mark_openers(Links& links) {
  std::vector<bool> met(links.size(), false);
  for (std::size_t k = links.size(); k-- > 0;) {
    auto& l = links[k];
    if (l.first || l.parent < 0) continue;
    const auto parent = static_cast<std::size_t>(l.parent);
    l.opens = !met[parent];
    met[parent] = true;
  }
}

}  // namespace momenta
