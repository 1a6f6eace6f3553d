// Slots of loops in the sweeps: no two loops that are open in one front share one, and of loops of
// one size there are no more slots than are open at once. Of which bodies poses are wanted.

#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/dae/sweeps/slots/loop_plan.h>

#include <algorithm>
#include <set>
#include <vector>

namespace momenta::dae_slots {
namespace {

using equations::RandomTree;

struct Made {
  std::vector<int> parents;
  std::vector<LoopShape> loops;
};

/// A tree in depth-first order, with loops between its bodies and the ground.
Made made(unsigned seed, int rows) {
  RandomTree random(seed);
  Made m;
  const int bodies = 2 + random.below(30);
  for (int k = 0; k < bodies; ++k) {
    int parent = k - 1;  // an ancestor of the body before, or the ground
    for (int up = random.below(4); up > 0 && parent >= 0; --up)
      parent = m.parents[static_cast<std::size_t>(parent)];
    m.parents.push_back(parent);
  }
  for (int i = 1 + random.below(12); i > 0; --i) {
    const int a = random.below(bodies + 1) - 1, b = random.below(bodies + 1) - 1;
    if (a != b) m.loops.push_back({a, b, rows, rows == 2});
  }
  return m;
}

std::set<int> ancestors(const Made& m, int k) {
  std::set<int> all;
  for (; k >= 0; k = m.parents[static_cast<std::size_t>(k)]) all.insert(k);
  return all;
}
int root(const Made& m, int k) {
  while (k >= 0 && m.parents[static_cast<std::size_t>(k)] >= 0)
    k = m.parents[static_cast<std::size_t>(k)];
  return k;
}

int closing_body(const std::set<int>& a, const std::set<int>& b) {
  int closes_at = -1;
  for (const int k : a)
    if (b.contains(k)) closes_at = std::max(closes_at, k);
  return closes_at;
}

/// By front, bodies and then roots at the ground: the loops that are open there, by what that
/// means.
std::vector<std::vector<int>> open_loops(const Made& m) {
  const std::size_t n = m.parents.size();
  std::vector<std::vector<int>> fronts(2 * n);
  for (std::size_t i = 0; i < m.loops.size(); ++i) {
    const LoopShape& loop = m.loops[i];
    const std::set<int> a = ancestors(m, loop.a), b = ancestors(m, loop.b);
    const int closes_at = closing_body(a, b);
    for (std::size_t k = 0; k < n; ++k) {
      const int body = static_cast<int>(k);
      if (a.contains(body) != b.contains(body) || body == closes_at)
        fronts[k].push_back(static_cast<int>(i));
    }
    if (closes_at >= 0) continue;
    int first = root(m, loop.a), last = root(m, loop.b);
    if (first < 0) first = last;
    if (last < 0) last = first;
    for (int k = std::min(first, last); k <= std::max(first, last); ++k)
      if (m.parents[static_cast<std::size_t>(k)] < 0)
        fronts[n + static_cast<std::size_t>(k)].push_back(static_cast<int>(i));
  }
  return fronts;
}

// Below the body that closes a loop alone, from its axes; what else loops close at stands still.
TEST(Poses, AreWantedBelowWhereLoopsClose) {
  int standing = 0, spared = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const Made m = made(seed, 2);
    const LoopPlan plan = plan_loops(m.parents, m.loops, false);
    for (std::size_t k = 0; k < m.parents.size(); ++k) {
      const int body = static_cast<int>(k);
      OnWay expected = OnWay::no;
      for (const LoopShape& loop : m.loops) {
        const std::set<int> a = ancestors(m, loop.a), b = ancestors(m, loop.b);
        if (a.contains(body) != b.contains(body)) expected = OnWay::moved;
        if (closing_body(a, b) == body && expected == OnWay::no) expected = OnWay::at_rest;
      }
      ASSERT_EQ(plan.posed[k], expected) << "seed " << seed << ", body " << k;
      standing += expected == OnWay::at_rest;
      spared += expected == OnWay::no;
    }
  }
  EXPECT_GT(standing, 100);
  EXPECT_GT(spared, 100);
}

TEST(SlotsOfFronts, AreAsManyAsLoopsAreOpenAtOnce) {
  int shared = 0;
  for (const int rows : {1, 2, 3, 5})
    for (unsigned seed = 0; seed < 500; ++seed) {
      const Made m = made(seed, rows);
      const LoopPlan plan = plan_loops(m.parents, m.loops, false);
      std::size_t open = 0;
      std::int64_t work = 0;
      for (const std::vector<int>& front : open_loops(m)) {
        open = std::max(open, front.size());
        work += static_cast<std::int64_t>(front.size() * front.size()) * rows * rows;
        std::set<int> slots;
        for (const int loop : front) slots.insert(plan.slot[static_cast<std::size_t>(loop)]);
        ASSERT_EQ(slots.size(), front.size()) << "two loops in one slot, seed " << seed;
        for (const int slot : slots) ASSERT_EQ(slot % rows, 0);
      }
      if (static_cast<int>(open) * rows > 60) continue;  // no more are counted
      ASSERT_EQ(plan.slots, static_cast<int>(open) * rows) << "seed " << seed;
      ASSERT_EQ(plan.work, work) << "seed " << seed;
      shared += m.loops.size() > open;
    }
  EXPECT_GT(shared, 300);
}

}  // namespace
}  // namespace momenta::dae_slots
