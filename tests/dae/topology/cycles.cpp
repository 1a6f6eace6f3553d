// Exchanges of joints for loops against counts made from nothing: what they change, that no single
// one is left that lowers the work, and that cuts lie in the middle of their cycles.

#include <gtest/gtest.h>
#include <momenta/dae/topology/cut/cycles.h>

#include <random>

namespace momenta::dae_cycles {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// A random tree on so many vertices and further edges between any two of them.
std::vector<CutEdge> random_graph(std::mt19937& bits, int vertices, int loops) {
  const auto below = [&](int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); };
  std::vector<CutEdge> edges;
  for (int v = 1; v < vertices; ++v)
    edges.push_back({v, std::max(0, v - 1 - below(4)), 2 + below(2), true, below(6) == 0});
  while (loops > 0) {
    const int a = below(vertices), b = below(vertices);
    if (a == b) continue;
    edges.push_back({a, b, 1 + below(3), false, below(6) == 0});
    --loops;
  }
  return edges;
}

/// Joints between the ends of an edge, in the tree: by taking leaves away until none but they are
/// left. False where the tree does not join them.
bool way_between(int vertices, const std::vector<CutEdge>& edges, const CutEdge& ends,
                 std::vector<char>& on_way) {
  on_way.assign(edges.size(), 0);
  std::vector<int> degree(at(vertices));
  int joints = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges[i].in_tree)
      on_way[i] = 1, ++joints, ++degree[at(edges[i].a)], ++degree[at(edges[i].b)];
  if (joints != vertices - 1) return false;
  for (bool taken = true; taken;) {
    taken = false;
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (const int v : {edges[i].a, edges[i].b})
        if (on_way[i] && degree[at(v)] == 1 && v != ends.a && v != ends.b) {
          on_way[i] = 0, --degree[at(edges[i].a)], --degree[at(edges[i].b)];
          taken = true;
        }
  }
  return degree[at(ends.a)] == 1 && degree[at(ends.b)] == 1;
}

/// J of the head of cycles.h, by its definition.
std::int64_t counted_work(int vertices, const std::vector<CutEdge>& edges) {
  std::vector<std::int64_t> open(edges.size());
  std::vector<char> on_way;
  for (const CutEdge& e : edges) {
    if (e.in_tree) continue;
    EXPECT_TRUE(way_between(vertices, edges, e, on_way)) << "not a tree";
    for (std::size_t j = 0; j < edges.size(); ++j) open[j] += on_way[j] ? e.rows : 0;
  }
  std::int64_t work = 0;
  for (const std::int64_t k : open) work += k * k;
  return work;
}

std::int64_t counted_depth(int vertices, const std::vector<CutEdge>& edges) {
  std::vector<char> on_way;
  std::int64_t sum = 0;
  for (int v = 1; v < vertices; ++v) {
    EXPECT_TRUE(way_between(vertices, edges, {0, v, 0, false, false}, on_way));
    sum += std::count(on_way.begin(), on_way.end(), 1);
  }
  return sum;
}

std::vector<CutEdge> exchanged(std::vector<CutEdge> edges, int e, int f) {
  edges[at(e)].in_tree = true;
  edges[at(f)].in_tree = false;
  return edges;
}

TEST(Cycles, ExchangesChangeWhatTheyAreSaidTo) {
  std::mt19937 bits(7);
  int made = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int vertices = 4 + trial % 20;
    Cycles cycles(vertices, random_graph(bits, vertices, 1 + trial % 9));
    ASSERT_EQ(cycles.work(), counted_work(vertices, cycles.edges()));
    for (int step = 0; step < 24; ++step) {
      const int e = static_cast<int>(bits() % cycles.edges().size());
      if (cycles.edges()[at(e)].in_tree || cycles.cycle(e).empty()) continue;
      const auto& ring = cycles.cycle(e);
      const int f = ring[bits() % ring.size()];
      const auto after = exchanged(cycles.edges(), e, f);
      const std::int64_t before = cycles.work();
      ASSERT_EQ(before + cycles.gain(e, f), counted_work(vertices, after));
      cycles.exchange(e, f);
      ++made;
      ASSERT_EQ(cycles.edges(), after);
      ASSERT_EQ(cycles.work(), counted_work(vertices, after));
      ASSERT_EQ(cycles.depth(), counted_depth(vertices, after));
      // the cycle of every loop is the way between its ends
      std::vector<char> on_way;
      for (std::size_t l = 0; l < after.size(); ++l) {
        if (after[l].in_tree) continue;
        ASSERT_TRUE(way_between(vertices, after, after[l], on_way));
        std::vector<char> said(after.size());
        for (const int j : cycles.cycle(static_cast<int>(l))) said[at(j)] = 1;
        ASSERT_EQ(said, on_way);
      }
    }
  }
  EXPECT_GT(made, 300);
}

TEST(Cycles, NoExchangeIsLeftThatLowersTheWork) {
  std::mt19937 bits(11);
  int lowered = 0;
  for (int trial = 0; trial < 80; ++trial) {
    const int vertices = 4 + trial % 16;
    const auto given = random_graph(bits, vertices, 1 + trial % 8);
    for (const bool shallow : {false, true}) {
      const auto first = shallow ? shallow_tree(vertices, given) : given;
      Cycles cycles(vertices, first);
      const std::int64_t before = counted_work(vertices, first);
      EXPECT_GT(cycles.descend(1'000'000), 0);
      const auto& found = cycles.edges();
      EXPECT_LE(cycles.work(), before);
      lowered += cycles.work() < before;
      for (std::size_t e = 0; e < found.size(); ++e) {
        EXPECT_TRUE(!given[e].fixed || found[e].in_tree == given[e].in_tree) << "was to stay";
        if (found[e].in_tree || found[e].fixed) continue;
        for (const int f : cycles.cycle(static_cast<int>(e))) {
          if (found[at(f)].fixed || found[at(f)].rows > found[e].rows) continue;
          EXPECT_GE(counted_work(vertices, exchanged(found, static_cast<int>(e), f)),
                    cycles.work());
        }
      }
      const std::int64_t work = cycles.work(), depth = counted_depth(vertices, found);
      cycles.balance(1'000'000);
      EXPECT_LE(cycles.work(), work);
      EXPECT_LE(counted_depth(vertices, cycles.edges()), depth);
    }
  }
  EXPECT_GT(lowered, 30);
}

TEST(Cycles, OneLongCycleIsCutInTheMiddle) {
  constexpr int bodies = 101;
  std::vector<CutEdge> ring;
  for (int v = 1; v <= bodies; ++v) ring.push_back({v - 1, v, 2, true, false});
  ring.push_back({bodies, 0, 2, false, false});
  Cycles cycles(bodies + 1, ring);
  EXPECT_EQ(cycles.depth(), bodies * (bodies + 1) / 2);
  cycles.balance(1'000'000);
  EXPECT_EQ(cycles.depth(), 51 * 52 / 2 + 50 * 51 / 2);
  EXPECT_EQ(length_of_cycles(bodies + 1, cycles.edges(), 1000), bodies);
}

/// A ladder: two uprights of n joints, tied by n rungs, one of them to the ground.
std::vector<CutEdge> ladder_graph(int n) {
  std::vector<CutEdge> edges;
  for (int i = 0; i < n; ++i) {
    const int left = 2 * i + 1, right = left + 1;
    edges.push_back({i == 0 ? 0 : left - 2, left, 2, true, false});
    edges.push_back({i == 0 ? 0 : right - 2, right, 2, true, false});
    edges.push_back({left, right, 2, false, false});
  }
  return edges;
}

TEST(Cycles, ADeepTreeOfABandHasShortCycles) {
  const auto work = [](int n, bool deep) {
    const auto edges = ladder_graph(n);
    const int vertices = 2 * n + 1;
    return Cycles(vertices, deep ? deep_tree(vertices, edges) : shallow_tree(vertices, edges))
        .work();
  };
  // along the band the same at every rung; across it all loops are open at its foot
  EXPECT_EQ(work(40, true) - work(30, true), work(30, true) - work(20, true));
  EXPECT_GT(work(40, false) - work(30, false), 10 * (work(40, true) - work(30, true)));
}

TEST(Cycles, ADeepTreeKeepsWhatIsFixed) {
  std::mt19937 bits(3);
  for (int seed = 0; seed < 50; ++seed) {
    const auto edges = random_graph(bits, 30, 20), deep = deep_tree(30, edges);
    int joints = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      joints += deep[i].in_tree;
      EXPECT_TRUE(!edges[i].fixed || deep[i].in_tree == edges[i].in_tree) << seed << " " << i;
    }
    EXPECT_EQ(joints, 29) << seed;
    EXPECT_EQ(Cycles(30, deep).work(), counted_work(30, deep)) << seed;
  }
}

}  // namespace
}  // namespace momenta::dae_cycles
