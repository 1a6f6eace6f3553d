#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <set>
#include <utility>

namespace momenta {
namespace {

/// Bodies whose fronts a loop is open in, and the body that closes it (−1: the ground).
struct Way {
  std::vector<int> fronts;
  int closes_at = -1;
  int root_a = -1, root_b = -1;

  /// The child of the closing body whose front brings the last end; −1: the first child, whose
  /// front goes on as the body's own, or none.
  int closing_child(const std::vector<int>& parents) const {
    int child = -1;
    for (const int k : fronts)
      if (k != closes_at && parents[static_cast<std::size_t>(k)] == closes_at)
        child = child < 0 ? k : std::min(child, k);
    return closes_at < 0 || child == closes_at + 1 ? -1 : child;
  }
};

Way way_of(const std::vector<int>& parents, const LoopShape& loop) {
  Way way;
  int a = loop.a, b = loop.b;
  const auto up = [&](int& k, int& root) {
    way.fronts.push_back(k);
    root = k;
    k = parents[static_cast<std::size_t>(k)];
  };
  // In depth-first order the later body is no ancestor of the earlier one: climb from it.
  while (a != b) {
    if (a > b)
      up(a, way.root_a);
    else
      up(b, way.root_b);
  }
  way.closes_at = a;
  if (a >= 0) way.fronts.push_back(a);
  return way;
}

/// Climbs from all joints at once, the last body first, until every way has passed its joint and
/// they have met.
Way way_of_coupler(const std::vector<int>& parents, const LoopShape& coupler) {
  std::set<int> at, joints;
  for (const auto& [body, ratio] : coupler.joints) joints.insert(body);
  at = joints;
  Way way;
  while (*at.rbegin() >= 0 && (at.size() > 1 || *at.rbegin() >= *joints.begin())) {
    const int k = *at.rbegin();
    at.erase(k);
    way.fronts.push_back(k);
    const int parent = parents[static_cast<std::size_t>(k)];
    if (parent < 0) {
      way.root_b = way.root_b < 0 ? k : way.root_b;  // the last root
      way.root_a = k;
    }
    at.insert(parent);
  }
  way.closes_at = *at.rbegin();
  if (way.closes_at >= 0) way.fronts.push_back(way.closes_at);
  return way;
}

/// Place of `rows` neighbouring free slots; pairs stand at even places, where registers hold them
/// together.
int first_fit(std::uint64_t used, int rows) {
  const std::uint64_t block = (std::uint64_t{1} << rows) - 1;
  const int stride = rows == 2 ? 2 : 1;
  int slot = 0;
  while (slot + rows <= 64 && (used & (block << slot)) != 0) slot += stride;
  return slot;
}

template <class T>
std::vector<LoopPlan::Range> ranges(const std::vector<std::vector<T>>& lists,
                                    std::vector<T>& flat) {
  std::vector<LoopPlan::Range> all;
  for (const auto& list : lists) {
    const int first = static_cast<int>(flat.size());
    flat.insert(flat.end(), list.begin(), list.end());
    all.push_back({first, static_cast<int>(flat.size())});
  }
  return all;
}

}  // namespace

namespace {

/// The root above each body, −1 above the ground.
class Roots {
 public:
  explicit Roots(const std::vector<int>& parents) {
    for (std::size_t k = 0; k < parents.size(); ++k)
      root_.push_back(parents[k] < 0 ? static_cast<int>(k) : of(parents[k]));
  }
  int of(int body) const { return body < 0 ? -1 : root_[static_cast<std::size_t>(body)]; }

 private:
  std::vector<int> root_;
};

/// Per body: of a root whose loops to other trees all end on one body before it, that body.
std::vector<int> foldable_looped_branches(const std::vector<int>& parents,
                                          const std::vector<LoopShape>& loops) {
  constexpr int none = -1, several = -2;
  const Roots roots(parents);
  std::vector<int> onto(parents.size(), none);
  const auto tie = [&](int root, int other) {
    if (root < 0) return;
    int& at = onto[static_cast<std::size_t>(root)];
    at = other < 0 || other > root || (at != none && at != other) ? several : other;
  };
  for (const LoopShape& loop : loops) {
    const int a = roots.of(loop.a), b = roots.of(loop.b);
    if (a == b) continue;
    tie(a, loop.b);
    tie(b, loop.a);
  }
  for (int& k : onto) k = std::max(k, none);
  return onto;
}

/// The fronts that a loop is open in: bodies, and those where a body's front is gathered with its
/// later siblings', at its parent or the ground.
struct Opened {
  std::vector<int> fronts, gathered;
  int closes_at = -1;
  int child = -1;  ///< closing_child()
  int root = -1;   ///< root at which it closes at the ground
};

/// Colours the fronts, the vertices of a tree: a body's own stands above its children's, next to
/// the first child's, with those where the others are gathered one below the other; roots one
/// behind the other above their own fronts. Each loop is open in a connected part: taken from the
/// top, a loop meets at its topmost front all taken before that are open anywhere with it, so that
/// as many slots do as are open at once (for loops of one size: their graph is chordal; Gavril, J.
/// Combin. Theory B 16 (1974) 47).
void take_slots(const std::vector<int>& parents, const std::vector<LoopShape>& loops,
                const std::vector<Opened>& opened, LoopPlan& plan, std::vector<std::uint64_t>& used,
                std::vector<std::uint64_t>& used_gathered) {
  const auto n = static_cast<int>(parents.size());
  // Depth of child i = 1, 2 …: its parent's plus i, as it is gathered i − 1 below its parent.
  std::vector<int> depth, deepest;
  for (const int parent : parents) {
    depth.push_back(parent < 0 ? n : ++deepest[static_cast<std::size_t>(parent)]);
    deepest.push_back(depth.back());
  }
  const auto top = [&](const Opened& o) {
    return o.child >= 0       ? depth[static_cast<std::size_t>(o.child)] - 1
           : o.closes_at >= 0 ? depth[static_cast<std::size_t>(o.closes_at)]
                              : std::max(o.root, 0);  // a folded branch's loops have no root
  };
  std::vector<std::size_t> from_the_top(loops.size());
  std::iota(from_the_top.begin(), from_the_top.end(), std::size_t{0});
  std::stable_sort(from_the_top.begin(), from_the_top.end(),
                   [&](std::size_t a, std::size_t b) { return top(opened[a]) < top(opened[b]); });
  plan.slot.resize(loops.size());
  for (const std::size_t i : from_the_top) {
    const auto each_front = [&](auto&& act) {
      for (const int k : opened[i].fronts) act(used[static_cast<std::size_t>(k)]);
      for (const int k : opened[i].gathered) act(used_gathered[static_cast<std::size_t>(k)]);
    };
    std::uint64_t taken = 0;
    each_front([&](std::uint64_t of_front) { taken |= of_front; });
    const int rows = loops[i].rows, slot = first_fit(taken, rows);
    plan.slot[i] = slot;
    plan.slots = std::max(plan.slots, slot + rows);
    if (slot + rows > 64) continue;
    const std::uint64_t own = ((std::uint64_t{1} << rows) - 1) << slot;
    each_front([&](std::uint64_t& of_front) { of_front |= own; });
  }
}

/// Per body that is no first child, the child of its parent before it; else −1.
std::vector<int> siblings_before(const std::vector<int>& parents) {
  std::vector<int> before(parents.size(), -1), last(parents.size(), -1);
  for (std::size_t k = 0; k < parents.size(); ++k)
    if (parents[k] >= 0)
      before[k] = std::exchange(last[static_cast<std::size_t>(parents[k])], static_cast<int>(k));
  return before;
}

/// `gathers`: loops close where children are gathered, not only in bodies' own fronts.
LoopPlan planned(const std::vector<int>& parents, const std::vector<LoopShape>& loops,
                 std::vector<int> folded_onto, bool gathers) {
  const std::size_t n = parents.size();
  LoopPlan plan;
  plan.takes_branches.assign(n, 0);
  for (const int k : folded_onto)
    if (k >= 0) plan.takes_branches[static_cast<std::size_t>(k)] = 1;
  std::vector<std::uint64_t> used(n, 0), used_gathered(n, 0);
  std::vector<std::vector<LoopPlan::End>> own_ends(n), gathered_ends(n);
  std::vector<std::vector<LoopPlan::Coupling>> couplings(n);
  std::vector<std::vector<int>> closings(n), gathered_closings(n);
  const std::vector<int> before = siblings_before(parents);
  const Roots above(parents);
  std::vector<int> roots;  // ascending
  for (std::size_t k = 0; k < n; ++k)
    if (parents[k] < 0) roots.push_back(static_cast<int>(k));

  RelativeWays ways(parents);
  std::vector<Opened> opened;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopShape& loop = loops[i];
    const int root_a = above.of(loop.a), root_b = above.of(loop.b);
    // The branch of a folded loop: its root; the loop is open in the branch alone.
    int looped_branch = -1;
    if (root_a != root_b)
      for (const int end : {root_a, root_b})
        if (end >= 0 && folded_onto[static_cast<std::size_t>(end)] >= 0)
          looped_branch = std::max(looped_branch, end);
    LoopShape open = loop;
    if (looped_branch >= 0) (looped_branch == root_a ? open.b : open.a) = -1;
    Way way = loop.joints.empty() ? way_of(parents, open) : way_of_coupler(parents, loop);
    std::vector<int> gathered;
    const int child = gathers ? way.closing_child(parents) : -1;
    if (child >= 0) {
      gathered_closings[static_cast<std::size_t>(child)].push_back(static_cast<int>(i));
      way.fronts.pop_back();
    } else if (way.closes_at < 0) {
      const int a = way.root_a < 0 ? way.root_b : way.root_a,
                b = way.root_b < 0 ? way.root_a : way.root_b;
      const auto from = std::lower_bound(roots.begin(), roots.end(), std::min(a, b));
      const auto to = std::upper_bound(roots.begin(), roots.end(), std::max(a, b));
      gathered.assign(from, to);
      gathered_closings[static_cast<std::size_t>(gathered.front())].push_back(static_cast<int>(i));
    } else {
      closings[static_cast<std::size_t>(way.closes_at)].push_back(static_cast<int>(i));
    }
    if (looped_branch >= 0) gathered.clear();
    const int root = gathered.empty() ? -1 : gathered.front();
    if (gathers)
      for (const int front : way.fronts) {
        if (front == way.closes_at) continue;
        for (int k = front; before[static_cast<std::size_t>(k)] >= 0;
             k = before[static_cast<std::size_t>(k)]) {
          gathered.push_back(k);
          if (k == child) break;
        }
      }
    opened.push_back({way.fronts, std::move(gathered), way.closes_at, child, root});
    plan.pair.push_back(loop.pair);
    for (const auto& [body, ratio] : loop.joints)
      couplings[static_cast<std::size_t>(body)].push_back(
          {static_cast<int>(i), ratio, body == loop.joints.front().first});
    for (const int end : {loop.a, loop.b}) ways.up(end, looped_branch >= 0 ? -1 : way.closes_at);
    // The end that sweeps inward meet first brings the right-hand side along: that of the branch,
    // where there is one.
    const auto end = [&](int body, bool on_a, bool first) {
      if (body < 0) return;
      const bool waits = child >= 0 && body == way.closes_at;
      (waits ? gathered_ends[static_cast<std::size_t>(child)]
             : own_ends[static_cast<std::size_t>(body)])
          .push_back({static_cast<int>(i), on_a, first});
    };
    end(open.a, true, open.a >= open.b);
    end(open.b, false, open.b > open.a);
  }
  plan.posed = ways.found();
  take_slots(parents, loops, opened, plan, used, used_gathered);
  const auto add_work = [&](std::uint64_t open) {
    const std::int64_t equations = std::popcount(open);
    plan.work += equations * equations;
  };
  for (std::size_t k = 0; k < n; ++k) {
    add_work(used[k]);
    if (parents[k] < 0 || !gathered_closings[k].empty()) add_work(used_gathered[k]);
  }
  plan.ends_of.resize(n);
  plan.own_ends_of.resize(n);
  plan.gathered_ends_of.resize(n);
  const auto append = [&](const std::vector<LoopPlan::End>& some) {
    const int first = static_cast<int>(plan.ends.size());
    plan.ends.insert(plan.ends.end(), some.begin(), some.end());
    return LoopPlan::Range{first, static_cast<int>(plan.ends.size())};
  };
  std::vector<std::vector<std::size_t>> others(n);  // children but the first
  for (std::size_t k = 0; k < n; ++k)
    if (before[k] >= 0) others[static_cast<std::size_t>(parents[k])].push_back(k);
  for (std::size_t k = 0; k < n; ++k) {
    plan.own_ends_of[k] = append(own_ends[k]);
    for (const std::size_t child : others[k])
      plan.gathered_ends_of[child] = append(gathered_ends[child]);
    plan.ends_of[k] = {plan.own_ends_of[k].first, static_cast<int>(plan.ends.size())};
  }
  plan.couplings_of = ranges(couplings, plan.couplings);
  plan.closings_of = ranges(closings, plan.closings);
  plan.gathered_closings_of = ranges(gathered_closings, plan.closings);
  plan.folded_onto = std::move(folded_onto);
  return plan;
}

/// Whether a loop closes where children are gathered.
bool gathers(const LoopPlan& plan, const std::vector<int>& parents) {
  for (std::size_t k = 0; k < parents.size(); ++k)
    if (const auto& r = plan.gathered_closings_of[k]; parents[k] >= 0 && r.first != r.last)
      return true;
  return false;
}

/// Registers are filled with all lanes, open or not: fewer slots in as many lanes are no gain.
int width(const LoopPlan& plan) {
  return plan.slots > LoopPlan::most_slots ? plan.slots : lanes_for(plan.slots, true);
}

/// The plan with narrower fronts, gathered or not.
LoopPlan of_narrower_fronts(const std::vector<int>& parents, const std::vector<LoopShape>& loops,
                            const std::vector<int>& folded_onto) {
  LoopPlan gathered = planned(parents, loops, folded_onto, true);
  if (!gathers(gathered, parents)) return gathered;
  LoopPlan plan = planned(parents, loops, folded_onto, false);
  return width(gathered) < width(plan) ? gathered : plan;
}

}  // namespace

LoopPlan plan_loops(const std::vector<int>& parents, const std::vector<LoopShape>& loops,
                    bool may_fold, bool may_gather) {
  const std::vector<int> none(parents.size(), -1);
  LoopPlan plan =
      may_gather ? of_narrower_fronts(parents, loops, none) : planned(parents, loops, none, false);
  if (plan.fits() || !may_fold || plan.couples()) return plan;
  return plan_folded(parents, loops);
}

LoopPlan plan_folded(const std::vector<int>& parents, const std::vector<LoopShape>& loops) {
  return of_narrower_fronts(parents, loops, foldable_looped_branches(parents, loops));
}

}  // namespace momenta
