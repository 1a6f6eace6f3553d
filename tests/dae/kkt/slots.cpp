// Slots of loops in the sweeps: no two loops that are open in one front share one, and of loops of
// one size there are no more slots than are open at once. Of which bodies poses are wanted.

#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>

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
int closing_body(const std::set<int>& a, const std::set<int>& b) {
  int closes_at = -1;
  for (const int k : a)
    if (b.contains(k)) closes_at = std::max(closes_at, k);
  return closes_at;
}

/// Loops that are open together at some place of the inward sweep, and whether anything is
/// eliminated there.
struct Together {
  std::set<int> loops;
  bool eliminated = false;
};

/// The inward sweep with sets: bodies come one by one, each with all below it; a loop is open from
/// its first end to come until it closes, for which both must have come. `early`: it closes as soon
/// as they have, else when all children of the body have.
class Sets {
 public:
  Sets(const Made& m, bool early) : m_(m), early_(early) {
    std::set<int> come, open;
    for (int k = static_cast<int>(m.parents.size()); k-- > 0;) {
      if (m.parents[static_cast<std::size_t>(k)] >= 0) continue;
      open.merge(leaving(k, come));
      close(open, come, true, true);
    }
  }
  const std::vector<Together>& places() const { return places_; }
  bool closed_early() const { return closed_early_; }

 private:
  bool ends_in(int loop, const std::set<int>& bodies, bool ground) const {
    const LoopShape& l = m_.loops[static_cast<std::size_t>(loop)];
    const auto in = [&](int body) { return body < 0 ? ground : bodies.contains(body); };
    return in(l.a) && in(l.b);
  }
  void close(std::set<int>& open, const std::set<int>& come, bool ground, bool counts) {
    places_.push_back({open, counts});
    for (int i = 0; i < static_cast<int>(m_.loops.size()); ++i)
      if (open.contains(i) && ends_in(i, come, ground)) {
        open.erase(i);
        closed_.insert(i);
        places_.back().eliminated = true;
      }
  }
  /// What goes on from body k to its parent; `come` takes all bodies from k on.
  std::set<int> leaving(int k, std::set<int>& come) {
    std::vector<int> children;
    for (int i = static_cast<int>(m_.parents.size()); i-- > k;)
      if (m_.parents[static_cast<std::size_t>(i)] == k) children.push_back(i);
    std::set<int> open, all;
    for (std::size_t i = 0; i < children.size(); ++i) {
      open.merge(leaving(children[i], all));
      if (!early_ || i + 1 == children.size()) continue;  // the first goes on
      std::set<int> with_k = all;
      with_k.insert(k);
      close(open, with_k, false, false);
      closed_early_ |= places_.back().eliminated;
    }
    all.insert(k);
    for (int i = 0; i < static_cast<int>(m_.loops.size()); ++i) {
      const LoopShape& l = m_.loops[static_cast<std::size_t>(i)];
      if ((l.a == k || l.b == k) && !closed_.contains(i)) open.insert(i);
    }
    close(open, all, false, true);
    places_.back().eliminated = true;  // its joint
    come.merge(all);
    return open;
  }

  const Made& m_;
  bool early_, closed_early_ = false;
  std::vector<Together> places_;
  std::set<int> closed_;
};

// Below the body that closes a loop alone, from its axes; what else loops close at stands still.
TEST(Poses, AreWantedBelowWhereLoopsClose) {
  int standing = 0, spared = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const Made m = made(seed, 2);
    const LoopPlan plan = plan_loops(m.parents, m.loops, false, true);
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
  int shared = 0, early = 0;
  for (const int rows : {1, 2, 3, 5})
    for (unsigned seed = 0; seed < 500; ++seed) {
      const Made m = made(seed, rows);
      const LoopPlan plan = plan_loops(m.parents, m.loops, false, true);
      const auto most = [](const Sets& sets) {
        std::size_t open = 0;
        for (const Together& here : sets.places()) open = std::max(open, here.loops.size());
        return open;
      };
      const Sets late(m, false), gathered(m, true);
      const auto lanes = [&](const Sets& sets) {
        const int slots = static_cast<int>(most(sets)) * rows;
        return slots > LoopPlan::most_slots ? slots : lanes_for(slots, true);
      };
      const bool is_early = lanes(gathered) < lanes(late);
      const Sets& sets = is_early ? gathered : late;
      early += is_early;
      std::int64_t work = 0;
      for (const Together& here : sets.places()) {
        const std::set<int>& open = here.loops;
        if (here.eliminated)
          work += static_cast<std::int64_t>(open.size() * open.size()) * rows * rows;
        std::set<int> slots;
        for (const int loop : open) slots.insert(plan.slot[static_cast<std::size_t>(loop)]);
        ASSERT_EQ(slots.size(), open.size()) << "two loops in one slot, seed " << seed;
        for (const int slot : slots) ASSERT_EQ(slot % rows, 0);
      }
      const std::size_t open = most(sets);
      if (static_cast<int>(open) * rows > 60) continue;  // no more are counted
      ASSERT_EQ(plan.slots, static_cast<int>(open) * rows) << "seed " << seed;
      ASSERT_EQ(plan.work, work) << "seed " << seed;
      shared += m.loops.size() > open;
    }
  EXPECT_GT(shared, 300);
  EXPECT_GT(early, 40);
}

// A hand on an arm: fingers that each close a loop on the palm take the slots of one finger, not of
// all; a loop that goes on to the ground keeps its own. Cassie's foot: the loop of the plantar rod
// closes at the tarsus before the heel spring brings that of the achilles rod.
TEST(SlotsOfFronts, AreThoseOfOneLoopedChild) {
  for (int fingers = 1; fingers <= 6; ++fingers) {
    Made m;
    m.parents = {-1, 0};
    for (int i = 0; i < fingers; ++i) {
      const int first = static_cast<int>(m.parents.size());
      m.parents.insert(m.parents.end(), {1, first, 1});
      m.loops.push_back({first + 1, first + 2, 2, true});
    }
    EXPECT_EQ(plan_loops(m.parents, m.loops, false, true).slots, 2);
    for (LoopShape& l : m.loops) l.b = 1;
    EXPECT_EQ(plan_loops(m.parents, m.loops, false, true).slots, 2);
    m.loops.push_back({2, -1, 2, true});  // from the first finger, which comes last
    EXPECT_EQ(plan_loops(m.parents, m.loops, false, true).slots, 4);
  }
  const std::vector<int> leg{-1, 0, 0, 2, 3, 4, 4, 6, 4};
  const LoopPlan foot = plan_loops(leg, {{7, 8, 2, true}, {1, 5, 3}}, false, true);
  EXPECT_EQ(foot.slots, 3);
}

}  // namespace
}  // namespace momenta::dae_slots
