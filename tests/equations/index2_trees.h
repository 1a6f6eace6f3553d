#pragma once
// Order conditions of half-explicit methods for y' = f(t, y, z), 0 = g(t, y) of index 2, by their
// trees (Hairer, Wanner, Solving Ordinary Differential Equations II, VII.5):
//
//   y-trees  [t_1 … t_k, u_1 … u_l]_y   f differentiated k times by y and l times by z,
//   z-trees  [t_1 … t_k]_z              g differentiated k times, not [τ]_z and not [[u]_y]_z,
//
// of orders ρ([…]_y) = 1 + Σ ρ and ρ([…]_z) = Σ ρ − 1. With the product of what its sons have at a
// time c, as a polynomial in c: a y-tree has its integral, a z-tree its derivative. A method
// replaces both by its own weights; its order is that of the first tree on which y_1 differs.

#include <functional>
#include <vector>

namespace momenta::equations {

struct Index2Tree {
  bool z;
  int order;
  std::vector<std::size_t> sons;
};

/// All y-trees up to an order and the z-trees in them, sons before their fathers.
inline std::vector<Index2Tree> index2_trees(int highest) {
  std::vector<Index2Tree> trees;
  const auto only_son_is_z = [&](std::size_t t) {
    return trees[t].sons.size() == 1 && trees[trees[t].sons[0]].z;
  };
  // Calls found(sons) for every multiset of `among` whose orders add up to `left`.
  using Sons = std::vector<std::size_t>;
  const std::function<void(const Sons&, std::size_t, int, Sons&,
                           const std::function<void(const Sons&)>&)>
      choose = [&](const Sons& among, std::size_t from, int left, Sons& chosen,
                   const std::function<void(const Sons&)>& found) {
        if (left == 0) return found(chosen);
        for (std::size_t i = from; i < among.size(); ++i) {
          if (trees[among[i]].order > left) continue;
          chosen.push_back(among[i]);
          choose(among, i, left - trees[among[i]].order, chosen, found);
          chosen.pop_back();
        }
      };
  Sons y, all, chosen;
  for (int order = 1; order <= highest; ++order) {
    std::vector<Index2Tree> more;
    choose(all, 0, order - 1, chosen, [&](const Sons& s) { more.push_back({false, order, s}); });
    for (auto& tree : more) {
      y.push_back(trees.size());
      all.push_back(trees.size());
      trees.push_back(tree);
    }
    if (order == 1) continue;
    more.clear();
    choose(y, 0, order, chosen, [&](const Sons& s) {
      if (s.size() == 1 && (trees[s[0]].sons.empty() || only_son_is_z(s[0]))) return;
      more.push_back({true, order - 1, s});
    });
    for (auto& tree : more) {
      all.push_back(trees.size());
      trees.push_back(tree);
      // Its father without other sons is of this order.
      y.push_back(trees.size());
      all.push_back(trees.size());
      trees.push_back({false, order, {trees.size() - 1}});
    }
  }
  return trees;
}

}  // namespace momenta::equations
