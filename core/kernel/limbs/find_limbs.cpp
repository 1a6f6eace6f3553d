#include <momenta/core/kernel/child_order.h>
#include <momenta/core/kernel/limbs/limb_link.h>
#include <momenta/core/kernel/limbs/limbs.h>

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

namespace momenta {
namespace {

// In times of one pin in a chain: a pack of pins, what a tip takes less, and handing a limb over
// between lanes and trunk. What saves less than `least_saving` stays as it is.
constexpr double pack_cost = 1.7, tip_discount = 0.4, hand_over = 0.4, least_saving = 1;

/// Children of a body that is one of many of its shape: screwed or not, and their shapes.
using Children = std::vector<std::pair<bool, int>>;

struct Shapes {
  std::vector<int> of;                     ///< by link; −1: no limb
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
    possible[k] = possible[k] && l.kind == LinkKind::pin;
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

/// Saved by `count` limbs of `size` bodies in one pack.
double saved_by_pack(int size, int count) {
  return (count - pack_cost) * (size - tip_discount) - hand_over * count;
}
/// How many of `count` limbs go into packs: a last one only if that saves something.
int packed(int size, int count, int lanes) {
  const int last = count % lanes;
  return saved_by_pack(size, last) > 0 ? count : count - last;
}
double saving(int size, int count, int lanes) {
  const int last = packed(size, count, lanes) % lanes;
  return count / lanes * saved_by_pack(size, lanes) + (last > 0 ? saved_by_pack(size, last) : 0);
}

/// Roots of the limbs to take, by shape: the most saving first, of what is left each time. A
/// shape's saving only shrinks while others are taken, so the one that is still on top when looked
/// at anew is the best.
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

/// Bodies of the limb at `root` in the shape's order.
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

LimbGroup group_of(const LinkTree& tree, const Shapes& s, const int* roots, int count, int lanes) {
  LimbGroup g;
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
    place.tip = k + 1 == parents.size() || parents[k + 1] != static_cast<int>(k);
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
      g.links.push_back(link);
      g.q.push_back(l.q);
      g.u.push_back(l.u);
    }
  }
  mark_openers(g.places);
  return g;
}

/// The tree without its limbs: links and bodies renumbered, slots where limbs arrive.
void build_trunk(const LinkTree& tree, const std::vector<char>& in_limb, Limbs& limbs) {
  limbs.trunk_model = *tree.model;
  limbs.trunk_model.bodies.clear();
  limbs.trunk = tree;
  auto& trunk = limbs.trunk;
  trunk.links.clear();
  trunk.theta0.clear();
  trunk.weight.clear();
  trunk.slots = 0;
  const std::size_t n = tree.links.size();
  std::vector<int> number(n, -1);
  for (std::size_t k = 0; k < n; ++k) {
    if (in_limb[k]) continue;
    const int here = static_cast<int>(trunk.links.size());
    number[k] = here;
    limbs.bodies.push_back(static_cast<int>(k));
    Link l = tree.links[k];
    auto b = tree.model->bodies[k];
    if (l.parent >= 0) l.parent = b.parent = number[static_cast<std::size_t>(l.parent)];
    l.first = l.parent >= 0 && l.parent + 1 == here;
    l.slot = -1;
    l.opens = false;
    l.carries_limbs_alone = false;
    if (l.parent >= 0 && !l.first) {
      int& slot = trunk.links[static_cast<std::size_t>(l.parent)].slot;
      if (slot < 0) slot = trunk.slots++;
    }
    trunk.links.push_back(l);
    trunk.theta0.push_back(tree.theta0[k]);
    trunk.weight.push_back(tree.weight[k]);
    limbs.trunk_model.bodies.push_back(b);
  }
  mark_openers(trunk.links);
  std::vector<char> reached(trunk.links.size(), 0);
  for (LimbGroup& g : limbs.groups) {
    g.one_parent = true;
    const auto parent_of = [&](int limb) {
      return tree.links[static_cast<std::size_t>(g.links[static_cast<std::size_t>(limb)])].parent;
    };
    for (int i = 0; i < g.count; ++i) {
      const int parent = parent_of(i);
      g.one_parent = g.one_parent && parent == parent_of(0);
      if (parent < 0) {
        g.trunk_slots.push_back(-1);
        g.opens.push_back(0);
        continue;
      }
      const auto at = static_cast<std::size_t>(number[static_cast<std::size_t>(parent)]);
      int& slot = trunk.links[at].slot;
      if (slot < 0) slot = trunk.slots++;
      g.trunk_slots.push_back(slot);
      g.opens.push_back(!reached[at]);
      reached[at] = 1;
    }
  }
  // Limbs are there before the trunk is swept: its own children only add.
  for (std::size_t k = 0; k < trunk.links.size(); ++k) {
    Link& l = trunk.links[k];
    if (l.parent >= 0 && reached[static_cast<std::size_t>(l.parent)]) l.opens = false;
    const bool bare =
        k + 1 == trunk.links.size() || trunk.links[k + 1].parent != static_cast<int>(k);
    l.carries_limbs_alone = bare && reached[k];
    if (l.carries_limbs_alone && l.kind != LinkKind::pin) l.tip = true;
    const bool in_chain = l.kind == LinkKind::pin && l.first && !l.tip && l.slot < 0 &&
                          !l.screwed && l.turn != Turn::tilted;
    l.path = in_chain ? static_cast<Path>(l.turn) : Path::any;
  }
}

}  // namespace

std::unique_ptr<Limbs> find_limbs(const LinkTree& tree, int lanes) {
  const Shapes shapes = shapes_of(tree);
  const auto chosen = choose(tree, shapes, lanes);
  if (chosen.empty()) return nullptr;
  auto limbs = std::make_unique<Limbs>();
  std::vector<char> in_limb(tree.links.size(), 0);
  for (const auto& roots : chosen)
    for (std::size_t first = 0; first < roots.size(); first += static_cast<std::size_t>(lanes)) {
      const int count = std::min(lanes, static_cast<int>(roots.size() - first));
      limbs->groups.push_back(group_of(tree, shapes, roots.data() + first, count, lanes));
      for (const int link : limbs->groups.back().links) in_limb[static_cast<std::size_t>(link)] = 1;
    }
  build_trunk(tree, in_limb, *limbs);
  limbs->trunk.model = &limbs->trunk_model;
  return limbs;
}

std::string limbs_in_words(const LinkTree& tree, int lanes) {
  const auto limbs = find_limbs(tree, lanes);
  if (!limbs) return "";
  std::map<std::size_t, int, std::greater<>> counts;
  for (const LimbGroup& g : limbs->groups) counts[g.places.size()] += g.count;
  std::string words;
  for (const auto& [size, count] : counts)
    words += (words.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(size) +
             (size == 1 ? " pin" : " pins");
  return words + " side by side in " + std::to_string(lanes) + " lanes";
}

}  // namespace momenta
