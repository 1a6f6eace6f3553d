#include <momenta/core/kernel/branches/branch_link.h>
#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/kernel/child_order.h>

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

namespace momenta {
namespace {

// In times of one revolute joint in a chain: cost of a pack of joints, discount of a leaf, cost of
// handing a branch over, least saving of a shape that is taken.
constexpr double pack_cost = 1.7, leaf_discount = 0.4, hand_over = 0.4, least_saving = 1;

/// Children of a body that give its shape: screwed or not, and their shapes.
using Children = std::vector<std::pair<bool, int>>;

struct Shapes {
  std::vector<int> of;                     ///< shape by link; −1: no branch
  std::vector<int> size;                   ///< bodies of the subtree, by link
  std::vector<std::vector<int>> children;  ///< by link, in the shape's order
  std::vector<std::vector<int>> roots;     ///< by shape, ascending
};

Shapes shapes_of(const LinkTree& tree) {
  const std::size_t n = tree.links.size();
  Shapes s{std::vector<int>(n, -1), std::vector<int>(n, 1), std::vector<std::vector<int>>(n), {}};
  std::vector<char> possible(n, 1);
  std::map<Children, int> numbers;
  for (std::size_t k = n; k-- > 0;) {
    const Link& l = tree.links[k];
    const auto parent = static_cast<std::size_t>(l.parent);
    possible[k] = possible[k] && l.kind == LinkKind::revolute &&
                  !tree.model->bodies[k].stop.acts();  // lanes have no stops
    if (possible[k]) {
      auto& children = s.children[k];
      std::sort(children.begin(), children.end(), [&](int a, int b) {
        const auto key = [&](int child) {
          const auto c = static_cast<std::size_t>(child);
          return std::pair(std::pair(tree.links[c].screwed, s.of[c]), child);
        };
        return key(a) < key(b);
      });
      Children shape;
      for (const int c : children)
        shape.emplace_back(tree.links[static_cast<std::size_t>(c)].screwed,
                           s.of[static_cast<std::size_t>(c)]);
      const auto [at, is_new] = numbers.emplace(shape, static_cast<int>(s.roots.size()));
      if (is_new) s.roots.emplace_back();
      s.of[k] = at->second;
      s.roots[static_cast<std::size_t>(at->second)].push_back(static_cast<int>(k));
    }
    if (l.parent < 0) continue;
    s.size[parent] += s.size[k];
    s.children[parent].push_back(static_cast<int>(k));
    possible[parent] = possible[parent] && possible[k];
  }
  for (auto& roots : s.roots) std::reverse(roots.begin(), roots.end());
  return s;
}

/// Saving by `count` branches of `size` bodies in one pack.
double saved_by_pack(int size, int count) {
  return (count - pack_cost) * (size - leaf_discount) - hand_over * count;
}
/// Number of `count` branches that go into packs: a last pack only if it saves something.
int packed(int size, int count, int lanes) {
  const int last = count % lanes;
  return saved_by_pack(size, last) > 0 ? count : count - last;
}
double saving(int size, int count, int lanes) {
  const int last = packed(size, count, lanes) % lanes;
  return count / lanes * saved_by_pack(size, lanes) + (last > 0 ? saved_by_pack(size, last) : 0);
}

/// Roots of the branches to take, by shape, the most saving shape first at each choice. Savings
/// only shrink while others are taken: a shape still on top when evaluated anew is the best.
std::vector<std::vector<int>> choose(const LinkTree& tree, const Shapes& s, int lanes) {
  const std::size_t n = tree.links.size();
  std::vector<char> taken(n, 0), holds_one(n, 0);
  const auto left = [&](int shape) {
    std::vector<int> roots;
    for (const int r : s.roots[static_cast<std::size_t>(shape)])
      if (!taken[static_cast<std::size_t>(r)] && !holds_one[static_cast<std::size_t>(r)])
        roots.push_back(r);
    return roots;
  };
  const auto saved = [&](const std::vector<int>& roots) {
    return roots.empty() ? 0.0
                         : saving(s.size[static_cast<std::size_t>(roots.front())],
                                  static_cast<int>(roots.size()), lanes);
  };
  std::priority_queue<std::pair<double, int>> order;
  for (std::size_t i = 0; i < s.roots.size(); ++i)
    order.emplace(saved(s.roots[i]), -static_cast<int>(i));
  std::vector<std::vector<int>> chosen;
  while (!order.empty() && order.top().first >= least_saving) {
    const int shape = -order.top().second;
    order.pop();
    std::vector<int> roots = left(shape);
    const double now = saved(roots);
    if (!order.empty() && now < order.top().first) {
      order.emplace(now, -shape);
      continue;
    }
    if (now < least_saving) continue;
    roots.resize(static_cast<std::size_t>(packed(s.size[static_cast<std::size_t>(roots.front())],
                                                 static_cast<int>(roots.size()), lanes)));
    for (const int r : roots) {
      const auto first = taken.begin() + r;
      std::fill(first, first + s.size[static_cast<std::size_t>(r)], char(1));
      for (int up = tree.links[static_cast<std::size_t>(r)].parent;
           up >= 0 && !holds_one[static_cast<std::size_t>(up)];
           up = tree.links[static_cast<std::size_t>(up)].parent)
        holds_one[static_cast<std::size_t>(up)] = 1;
    }
    chosen.push_back(std::move(roots));
  }
  return chosen;
}

/// Bodies of the branch at `root` in the shape's order.
void list_bodies(const Shapes& s, int root, int parent, std::vector<int>& bodies,
                 std::vector<int>& parents) {
  // Depth-first without recursion: chains are deep.
  std::vector<std::pair<int, int>> open{{root, parent}};
  while (!open.empty()) {
    const auto [k, up] = open.back();
    open.pop_back();
    const int place = static_cast<int>(bodies.size());
    bodies.push_back(k);
    parents.push_back(up);
    const auto& children = s.children[static_cast<std::size_t>(k)];
    for (auto c = children.rbegin(); c != children.rend(); ++c) open.emplace_back(*c, place);
  }
}

BranchGroup group_of(const LinkTree& tree, const Shapes& s, const int* roots, int count,
                     int lanes) {
  BranchGroup g;
  g.count = count;
  g.lanes = lanes;
  std::vector<std::vector<int>> bodies(static_cast<std::size_t>(count));
  std::vector<int> parents;
  for (int i = 0; i < count; ++i) {
    parents.clear();
    list_bodies(s, roots[i], -1, bodies[static_cast<std::size_t>(i)], parents);
  }
  g.places.resize(parents.size());
  for (std::size_t k = 0; k < parents.size(); ++k) {
    auto& place = g.places[k];
    place.parent = parents[k];
    place.first = parents[k] >= 0 && parents[k] + 1 == static_cast<int>(k);
    place.leaf = k + 1 == parents.size() || parents[k + 1] != static_cast<int>(k);
    if (parents[k] >= 0 && !place.first) {
      auto& above = g.places[static_cast<std::size_t>(parents[k])];
      if (above.slot < 0) above.slot = g.slots++;
    }
    for (int lane = 0; lane < lanes; ++lane) {
      const int link = bodies[static_cast<std::size_t>(std::min(lane, count - 1))][k];
      const Link& l = tree.links[static_cast<std::size_t>(link)];
      if (lane == 0) place.turn = l.turn;
      place.turn = common_turn(place.turn, l.turn);
      place.screwed |= l.screwed;
      place.has_force |= l.has_force;
      place.is_curved |= tree.model->bodies[static_cast<std::size_t>(link)].is_curved;
      place.has_rotor |= l.has_rotor;
      g.links.push_back(link);
      g.q.push_back(l.q);
      g.u.push_back(l.u);
    }
  }
  mark_openers(g.places);
  return g;
}

/// The tree without its branches: links and bodies renumbered, slots where branches arrive.
void build_remaining_tree(const LinkTree& tree, const std::vector<char>& in_branch,
                          Branches& branches) {
  branches.remaining_tree_model = *tree.model;
  branches.remaining_tree_model.bodies.clear();
  branches.remaining_tree = tree;
  auto& remaining_tree = branches.remaining_tree;
  remaining_tree.links.clear();
  remaining_tree.theta0.clear();
  remaining_tree.weight.clear();
  remaining_tree.slots = 0;
  const std::size_t n = tree.links.size();
  std::vector<int> number(n, -1);
  for (std::size_t k = 0; k < n; ++k) {
    if (in_branch[k]) continue;
    const int here = static_cast<int>(remaining_tree.links.size());
    number[k] = here;
    branches.bodies.push_back(static_cast<int>(k));
    Link l = tree.links[k];
    auto b = tree.model->bodies[k];
    if (l.parent >= 0) l.parent = b.parent = number[static_cast<std::size_t>(l.parent)];
    l.first = l.parent >= 0 && l.parent + 1 == here;
    l.slot = -1;
    l.opens = false;
    l.carries_branches_alone = false;
    if (l.parent >= 0 && !l.first) {
      int& slot = remaining_tree.links[static_cast<std::size_t>(l.parent)].slot;
      if (slot < 0) slot = remaining_tree.slots++;
    }
    remaining_tree.links.push_back(l);
    remaining_tree.theta0.push_back(tree.theta0[k]);
    remaining_tree.weight.push_back(tree.weight[k]);
    branches.remaining_tree_model.bodies.push_back(b);
  }
  mark_openers(remaining_tree.links);
  std::vector<char> reached(remaining_tree.links.size(), 0);
  for (BranchGroup& g : branches.groups) {
    g.one_parent = true;
    const auto parent_of = [&](int branch) {
      return tree.links[static_cast<std::size_t>(g.links[static_cast<std::size_t>(branch)])].parent;
    };
    for (int i = 0; i < g.count; ++i) {
      const int parent = parent_of(i);
      g.one_parent = g.one_parent && parent == parent_of(0);
      if (parent < 0) {
        g.remaining_tree_slots.push_back(-1);
        g.opens.push_back(0);
        continue;
      }
      const auto at = static_cast<std::size_t>(number[static_cast<std::size_t>(parent)]);
      int& slot = remaining_tree.links[at].slot;
      if (slot < 0) slot = remaining_tree.slots++;
      g.remaining_tree_slots.push_back(slot);
      g.opens.push_back(!reached[at]);
      reached[at] = 1;
    }
  }
  // Branches fill the slots before the remaining tree is swept: its own children only add.
  for (std::size_t k = 0; k < remaining_tree.links.size(); ++k) {
    Link& l = remaining_tree.links[k];
    if (l.parent >= 0 && reached[static_cast<std::size_t>(l.parent)]) l.opens = false;
    const bool bare = k + 1 == remaining_tree.links.size() ||
                      remaining_tree.links[k + 1].parent != static_cast<int>(k);
    l.carries_branches_alone = bare && reached[k];
    if (l.carries_branches_alone && l.kind != LinkKind::revolute) l.leaf = true;
  }
  set_paths(remaining_tree.links);
}

}  // namespace

std::unique_ptr<Branches> find_branches(const LinkTree& tree, int lanes) {
  const Shapes shapes = shapes_of(tree);
  const auto chosen = choose(tree, shapes, lanes);
  if (chosen.empty()) return nullptr;
  auto branches = std::make_unique<Branches>();
  std::vector<char> in_branch(tree.links.size(), 0);
  for (const auto& roots : chosen)
    for (std::size_t first = 0; first < roots.size(); first += static_cast<std::size_t>(lanes)) {
      const int count = std::min(lanes, static_cast<int>(roots.size() - first));
      branches->groups.push_back(group_of(tree, shapes, roots.data() + first, count, lanes));
      for (const int link : branches->groups.back().links)
        in_branch[static_cast<std::size_t>(link)] = 1;
    }
  build_remaining_tree(tree, in_branch, *branches);
  branches->remaining_tree.model = &branches->remaining_tree_model;
  return branches;
}

std::string branches_in_words(const LinkTree& tree, int lanes) {
  const auto branches = find_branches(tree, lanes);
  if (!branches) return "";
  std::map<std::size_t, int, std::greater<>> counts;
  for (const BranchGroup& g : branches->groups) counts[g.places.size()] += g.count;
  std::string words;
  for (const auto& [size, count] : counts)
    words += (words.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(size) +
             (size == 1 ? " revolute joint" : " revolute joints");
  return words + " side by side in " + std::to_string(lanes) + " lanes";
}

}  // namespace momenta
