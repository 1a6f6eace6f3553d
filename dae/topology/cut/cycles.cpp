#include <momenta/dae/topology/cut/cycles.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>

namespace momenta {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int other_end(const CutEdge& edge, int vertex) {
  return edge.a == vertex ? edge.b : edge.a;
}

/// Edges at each vertex.
std::vector<std::vector<int>> edges_at(int vertices, const std::vector<CutEdge>& edges) {
  std::vector<std::vector<int>> all(at(vertices));
  for (std::size_t i = 0; i < edges.size(); ++i) {
    all[at(edges[i].a)].push_back(static_cast<int>(i));
    all[at(edges[i].b)].push_back(static_cast<int>(i));
  }
  return all;
}

/// The edge of the tree above each vertex, −1 above the ground.
std::vector<int> parents(int vertices, const std::vector<CutEdge>& edges) {
  const auto beside = edges_at(vertices, edges);
  std::vector<int> parent_edge(at(vertices), -1), reached{0};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const int edge : beside[at(reached[i])]) {
      if (!edges[at(edge)].in_tree || edge == parent_edge[at(reached[i])]) continue;
      const int child = other_end(edges[at(edge)], reached[i]);
      parent_edge[at(child)] = edge;
      reached.push_back(child);
    }
  return parent_edge;
}

/// Joints between each vertex and the ground.
std::vector<int> depths(const std::vector<CutEdge>& edges, const std::vector<int>& parent_edge) {
  std::vector<int> depth(parent_edge.size(), -1), way;
  depth[0] = 0;
  for (std::size_t v = 1; v < depth.size(); ++v) {
    int w = static_cast<int>(v);
    for (; depth[at(w)] < 0; w = other_end(edges[at(parent_edge[at(w)])], w)) way.push_back(w);
    for (int steps = depth[at(w)]; !way.empty(); way.pop_back()) depth[at(way.back())] = ++steps;
  }
  return depth;
}

/// a + b mod 2, both ascending.
void sum_mod_2(const std::vector<int>& a, const std::vector<int>& b, std::vector<int>& sum) {
  sum.clear();
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(sum));
}

void insert_ascending(std::vector<int>& list, int value) {
  list.insert(std::lower_bound(list.begin(), list.end(), value), value);
}

}  // namespace

std::int64_t length_of_cycles(int vertices, const std::vector<CutEdge>& edges, std::int64_t most) {
  const std::vector<int> parent_edge = parents(vertices, edges);
  const std::vector<int> depth = depths(edges, parent_edge);
  std::int64_t length = 0;
  for (const CutEdge& e : edges) {
    if (e.in_tree) continue;
    for (int a = e.a, b = e.b; a != b && length <= most; ++length) {
      int& deeper = depth[at(a)] > depth[at(b)] ? a : b;
      deeper = other_end(edges[at(parent_edge[at(deeper)])], deeper);
    }
  }
  return length;
}

Cycles::Cycles(int vertices, std::vector<CutEdge> edges)
    : edges_(std::move(edges)),
      parent_edge_(parents(vertices, edges_)),
      cycle_(edges_.size()),
      through_(edges_.size()) {
  const std::vector<int> depth = depths(edges_, parent_edge_);
  const auto up = [&](int v) { return other_end(edges_[at(parent_edge_[at(v)])], v); };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (edges_[e].in_tree) continue;
    for (int a = edges_[e].a, b = edges_[e].b; a != b;) {
      int& deeper = depth[at(a)] > depth[at(b)] ? a : b;
      cycle_[e].push_back(parent_edge_[at(deeper)]);
      deeper = up(deeper);
    }
    for (const int j : cycle_[e]) through_[at(j)].push_back(static_cast<int>(e));
  }
  for (std::size_t j = 0; j < edges_.size(); ++j)
    if (edges_[j].in_tree) work_ += open(through_[j]) * open(through_[j]);
}

std::int64_t Cycles::depth() const {
  const std::vector<int> all = depths(edges_, parent_edge_);
  return std::accumulate(all.begin(), all.end(), std::int64_t{0});
}

std::int64_t Cycles::open(const std::vector<int>& loops) const {
  std::int64_t rows = 0;
  for (const int loop : loops) rows += edges_[at(loop)].rows;
  return rows;
}

bool Cycles::may_change(int e, int f) const {
  return !edges_[at(f)].fixed && edges_[at(f)].rows <= edges_[at(e)].rows;
}

std::int64_t Cycles::gain(int e, int f) {
  const std::int64_t own = edges_[at(e)].rows, new_own = edges_[at(f)].rows;
  const std::vector<int>& others = through_[at(f)];  // and e among them
  const std::int64_t old_f = open(others), joint_e = old_f - own + new_own;
  std::int64_t gain = joint_e * joint_e - old_f * old_f;
  for (const int j : cycle_[at(e)]) {
    if (j == f) continue;
    // e is on both: it goes out of the sum by itself.
    sum_mod_2(through_[at(j)], others, scratch_);
    looked_at_ += static_cast<std::int64_t>(through_[at(j)].size() + others.size());
    const std::int64_t before = open(through_[at(j)]), after = open(scratch_) + new_own;
    gain += after * after - before * before;
  }
  return gain;
}

void Cycles::exchange(int e, int f) {
  work_ += gain(e, f);
  // parents: bodies between an end of e and f come to hang on the other end
  std::vector<int> sorted = cycle_[at(e)];
  std::sort(sorted.begin(), sorted.end());
  const auto hangs_below_f = [&](int v) {
    for (; v != 0; v = other_end(edges_[at(parent_edge_[at(v)])], v)) {
      if (parent_edge_[at(v)] == f) return true;
      if (!std::binary_search(sorted.begin(), sorted.end(), parent_edge_[at(v)])) return false;
    }
    return false;
  };
  int v = hangs_below_f(edges_[at(e)].a) ? edges_[at(e)].a : edges_[at(e)].b, by = e;
  while (by != f) {
    const int above = other_end(edges_[at(parent_edge_[at(v)])], v);
    std::swap(by, parent_edge_[at(v)]);
    v = above;
  }
  // cycles
  std::vector<int> others = through_[at(f)];
  others.erase(std::find(others.begin(), others.end(), e));
  std::vector<int> ring = cycle_[at(e)];
  ring[at(static_cast<int>(std::find(ring.begin(), ring.end(), f) - ring.begin()))] = e;
  through_[at(f)] = {};
  through_[at(e)] = others;
  for (const int j : ring) {
    if (j != e) {
      std::vector<int>& loops = through_[at(j)];
      loops.erase(std::find(loops.begin(), loops.end(), e));
      sum_mod_2(loops, others, scratch_);
      loops = scratch_;
    }
    insert_ascending(through_[at(j)], f);
  }
  sorted = ring;
  std::sort(sorted.begin(), sorted.end());
  for (const int g : others) {
    std::vector<int>& own = cycle_[at(g)];
    looked_at_ += static_cast<std::int64_t>(10 * (own.size() + sorted.size()));  // they are sorted
    own.erase(std::find(own.begin(), own.end(), f));
    std::sort(own.begin(), own.end());
    sum_mod_2(own, sorted, scratch_);
    own = scratch_;
  }
  cycle_[at(e)] = {};
  cycle_[at(f)] = std::move(ring);
  edges_[at(e)].in_tree = true;
  edges_[at(f)].in_tree = false;
}

std::int64_t Cycles::descend(std::int64_t effort) {
  looked_at_ = 0;
  for (bool fell = true; fell;) {
    fell = false;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (edges_[i].in_tree || edges_[i].fixed) continue;
      const int e = static_cast<int>(i);
      int best = -1;
      std::int64_t least = 0;
      // joints that the same loops pass are worth the same
      std::vector<int> joints;
      for (const int f : cycle_[i])
        if (may_change(e, f)) joints.push_back(f);
      const auto same = [&](int f, int g) {
        return edges_[at(f)].rows == edges_[at(g)].rows && through_[at(f)] == through_[at(g)];
      };
      std::sort(joints.begin(), joints.end(), [&](int f, int g) {
        if (edges_[at(f)].rows != edges_[at(g)].rows)
          return edges_[at(f)].rows < edges_[at(g)].rows;
        return through_[at(f)] != through_[at(g)] ? through_[at(f)] < through_[at(g)] : f < g;
      });
      joints.erase(std::unique(joints.begin(), joints.end(), same), joints.end());
      for (const int f : joints) {
        const std::int64_t change = gain(e, f);
        if (change < least) least = change, best = f;
        if (looked_at_ > effort) return 0;
      }
      if (best < 0) continue;
      exchange(e, best);
      if (looked_at_ > effort) return 0;
      fell = true;
    }
  }
  return effort - looked_at_;
}

std::int64_t Cycles::balance(std::int64_t effort) {
  constexpr int most_tried = 8;
  looked_at_ = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (edges_[i].in_tree || edges_[i].fixed) continue;
      const int e = static_cast<int>(i);
      std::vector<int> sorted = cycle_[i];
      std::sort(sorted.begin(), sorted.end());
      looked_at_ += static_cast<std::int64_t>(sorted.size());
      if (looked_at_ > effort) return 0;
      const auto way_up = [&](int v) {
        std::vector<int> way;
        while (v != 0 && std::binary_search(sorted.begin(), sorted.end(), parent_edge_[at(v)])) {
          way.push_back(parent_edge_[at(v)]);
          v = other_end(edges_[at(way.back())], v);
        }
        return way;
      };
      const std::vector<int> a = way_up(edges_[i].a), b = way_up(edges_[i].b);
      const std::vector<int>& longer = a.size() > b.size() ? a : b;
      const int apart = std::abs(static_cast<int>(a.size()) - static_cast<int>(b.size()));
      // the cut n joints up the longer way: ways of longer − n and shorter + n
      int tried = 0;
      for (int off = 0; apart > 1 && off < apart / 2 && tried < most_tried; ++off) {
        int found = -1;
        for (const int n : {apart / 2 - off, (apart + 1) / 2 + off}) {
          if (n < 1 || n >= apart || tried == most_tried) continue;
          const int f = longer[at(n - 1)];
          if (!may_change(e, f)) continue;
          ++tried;
          if (gain(e, f) > 0) continue;
          found = f;
          break;
        }
        if (found < 0) continue;
        exchange(e, found);
        moved = true;
        break;
      }
    }
  }
  return effort - looked_at_;
}

namespace {

/// The spanning tree of the edges with the least keys; fixed joints are in it, fixed loops are not.
template <class Key>
std::vector<CutEdge> least_tree(int vertices, std::vector<CutEdge> edges, Key&& key) {
  std::vector<int> order(edges.size()), group(at(vertices));
  std::iota(order.begin(), order.end(), 0);
  std::iota(group.begin(), group.end(), 0);
  const auto whole_key = [&](int i) {
    const CutEdge& e = edges[at(i)];
    return std::tuple(!(e.fixed && e.in_tree), key(i), i);
  };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return whole_key(i) < whole_key(j); });
  const auto group_of = [&](int v) {
    while (group[at(v)] != v) v = group[at(v)] = group[at(group[at(v)])];
    return v;
  };
  for (const int i : order) {
    CutEdge& e = edges[at(i)];
    if (e.fixed && !e.in_tree) continue;
    const int a = group_of(e.a), b = group_of(e.b);
    e.in_tree = a != b;
    group[at(a)] = b;
  }
  return edges;
}

bool may_be_joint(const CutEdge& edge) {
  return !edge.fixed || edge.in_tree;
}

}  // namespace

std::vector<CutEdge> shallow_tree(int vertices, const std::vector<CutEdge>& edges) {
  std::vector<int> level(at(vertices), vertices), reached{0};
  level[0] = 0;
  const auto beside = edges_at(vertices, edges);
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const int edge : beside[at(reached[i])]) {
      if (!may_be_joint(edges[at(edge)])) continue;
      const int next = other_end(edges[at(edge)], reached[i]);
      if (level[at(next)] < vertices) continue;
      level[at(next)] = level[at(reached[i])] + 1;
      reached.push_back(next);
    }
  return least_tree(vertices, edges, [&](int i) {
    const CutEdge& e = edges[at(i)];
    return std::pair(-e.rows, std::min(level[at(e.a)], level[at(e.b)]));
  });
}

std::vector<CutEdge> deep_tree(int vertices, const std::vector<CutEdge>& edges) {
  const auto beside = edges_at(vertices, edges);
  std::vector<char> chosen(edges.size(), 0), reached(at(vertices), 0);
  std::vector<int> ties(at(vertices), 0), way;  // ties: to vertices that are reached
  const auto reach = [&](int v) {
    reached[at(v)] = 1;
    way.push_back(v);
    for (const int edge : beside[at(v)]) ++ties[at(other_end(edges[at(edge)], v))];
  };
  reach(0);
  while (!way.empty()) {
    int best = -1, next = -1;
    for (const int edge : beside[at(way.back())]) {
      if (!may_be_joint(edges[at(edge)])) continue;
      const int v = other_end(edges[at(edge)], way.back());
      if (reached[at(v)] || (best >= 0 && ties[at(v)] <= ties[at(next)])) continue;
      best = edge, next = v;
    }
    if (best < 0) {
      way.pop_back();
      continue;
    }
    chosen[at(best)] = 1;
    reach(next);
  }
  return least_tree(vertices, edges, [&](int i) { return chosen[at(i)] ? 0 : 1; });
}

}  // namespace momenta
