#include <momenta/dae/sweeps/loop_plan.h>

#include <algorithm>

namespace momenta {
namespace {

/// Bodies whose fronts a loop is open in, and the body that closes it (−1: the ground).
struct Way {
  std::vector<int> fronts;
  int closes_at = -1;
  int root_a = -1, root_b = -1;
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

/// Place of `rows` neighbouring free lanes; pairs stand at even places, where registers hold them
/// together.
int first_fit(std::uint64_t used, int rows) {
  const std::uint64_t block = (std::uint64_t{1} << rows) - 1;
  const int stride = rows == 2 ? 2 : 1;
  int lane = 0;
  while (lane + rows <= 64 && (used & (block << lane)) != 0) lane += stride;
  return lane;
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

LoopPlan plan_loops(const std::vector<int>& parents, const std::vector<LoopShape>& loops) {
  const std::size_t n = parents.size();
  LoopPlan plan;
  plan.lane.resize(loops.size());
  plan.posed.assign(n, 0);
  std::vector<std::uint64_t> used(n, 0), used_at_ground(n, 0);
  std::vector<std::vector<LoopPlan::End>> ends(n);
  std::vector<std::vector<int>> closings(n), ground_closings(n);
  std::vector<int> roots;  // ascending
  for (std::size_t k = 0; k < n; ++k)
    if (parents[k] < 0) roots.push_back(static_cast<int>(k));

  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopShape& loop = loops[i];
    const Way way = way_of(parents, loop);
    std::vector<int> gathered;
    if (way.closes_at < 0) {
      const int a = way.root_a < 0 ? way.root_b : way.root_a,
                b = way.root_b < 0 ? way.root_a : way.root_b;
      const auto from = std::lower_bound(roots.begin(), roots.end(), std::min(a, b));
      const auto to = std::upper_bound(roots.begin(), roots.end(), std::max(a, b));
      gathered.assign(from, to);
      ground_closings[static_cast<std::size_t>(gathered.front())].push_back(static_cast<int>(i));
    } else {
      closings[static_cast<std::size_t>(way.closes_at)].push_back(static_cast<int>(i));
    }
    std::uint64_t taken = 0;
    for (const int k : way.fronts) taken |= used[static_cast<std::size_t>(k)];
    for (const int k : gathered) taken |= used_at_ground[static_cast<std::size_t>(k)];
    const int lane = first_fit(taken, loop.rows);
    plan.lane[i] = lane;
    plan.lanes = std::max(plan.lanes, lane + loop.rows);
    if (lane + loop.rows <= 64) {
      const std::uint64_t own = ((std::uint64_t{1} << loop.rows) - 1) << lane;
      for (const int k : way.fronts) used[static_cast<std::size_t>(k)] |= own;
      for (const int k : gathered) used_at_ground[static_cast<std::size_t>(k)] |= own;
    }
    plan.pair.push_back(loop.pair);
    for (int end : {loop.a, loop.b})
      for (int k = end; k >= 0 && !plan.posed[static_cast<std::size_t>(k)];
           k = parents[static_cast<std::size_t>(k)])
        plan.posed[static_cast<std::size_t>(k)] = 1;
    if (loop.a >= 0) ends[static_cast<std::size_t>(loop.a)].push_back({static_cast<int>(i), true, true});
    if (loop.b >= 0)
      ends[static_cast<std::size_t>(loop.b)].push_back({static_cast<int>(i), false, loop.a < 0});
  }
  plan.ends_of = ranges(ends, plan.ends);
  plan.closings_of = ranges(closings, plan.closings);
  plan.ground_closings_of = ranges(ground_closings, plan.closings);
  return plan;
}

}  // namespace momenta
