#include <momenta/dae/mechanism/loop/shared_points.h>

#include <algorithm>
#include <map>

namespace momenta {
namespace {

/// A pair of nodes: x_from − x_to.
struct Pair {
  int from, to;
};

/// Nodes of one shared point and the ties on them.
struct Shared {
  std::vector<int> nodes;  ///< by body
  std::vector<int> ties;   ///< loops
};

int place_in(const std::vector<int>& nodes, int node) {
  return static_cast<int>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

int root_of(const std::vector<int>& parents, int body) {
  while (parents[static_cast<std::size_t>(body)] >= 0)
    body = parents[static_cast<std::size_t>(body)];
  return body;
}

/// Per pair of `wanted` the signed pairs of the tree `given` along the way from a to b, whose sum
/// is x_a − x_b.
std::vector<std::vector<std::pair<int, double>>> along(const std::vector<Pair>& given,
                                                       const std::vector<Pair>& wanted,
                                                       std::size_t nodes) {
  std::vector<std::vector<std::pair<int, double>>> ways(wanted.size());
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    std::vector<int> before(nodes, -1);  // the pair by which a node was reached
    std::vector<int> reached{wanted[w].from};
    std::vector<char> seen(nodes, 0);
    seen[static_cast<std::size_t>(wanted[w].from)] = 1;
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (std::size_t e = 0; e < given.size(); ++e) {
        const Pair& p = given[e];
        const int next = p.from == reached[i] ? p.to : p.to == reached[i] ? p.from : -1;
        if (next < 0 || seen[static_cast<std::size_t>(next)]) continue;
        seen[static_cast<std::size_t>(next)] = 1;
        before[static_cast<std::size_t>(next)] = static_cast<int>(e);
        reached.push_back(next);
      }
    for (int at = wanted[w].to; at != wanted[w].from;) {
      const int e = before[static_cast<std::size_t>(at)];
      const Pair& p = given[static_cast<std::size_t>(e)];
      const bool forward = p.to == at;
      ways[w].emplace_back(e, forward ? 1.0 : -1.0);
      at = forward ? p.from : p.to;
    }
  }
  return ways;
}

}  // namespace

template <class Space>
SharedPoints::SharedPoints(const std::vector<int>& parents, const LoopModel<Space>& loops,
                           LoopModel<Space>& paired_anew) {
  paired_anew = loops;
  // Nodes: a body's point; joined by ties into trees.
  struct Node {
    int body;
    typename LoopModel<Space>::Vector at;
  };
  std::vector<Node> nodes;
  std::map<std::vector<double>, int> known;
  std::vector<int> joined;
  const auto node_of = [&](int body, const typename LoopModel<Space>::Vector& at) {
    std::vector<double> key{static_cast<double>(body)};
    for (int i = 0; i < (Space::dimension == 6 ? 3 : 2); ++i) key.push_back(at[i]);
    const auto [place, fresh] = known.emplace(std::move(key), static_cast<int>(nodes.size()));
    if (fresh) {
      joined.push_back(static_cast<int>(nodes.size()));
      nodes.push_back({body, at});
    }
    return place->second;
  };
  const auto root = [&](int node) {
    while (joined[static_cast<std::size_t>(node)] != node)
      node = joined[static_cast<std::size_t>(node)] =
          joined[static_cast<std::size_t>(joined[static_cast<std::size_t>(node)])];
    return node;
  };
  std::vector<Pair> ends(loops.loops.size(), Pair{-1, -1});
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto& l = loops.loops[i];
    if (!l.is_tie) continue;
    ends[i] = {node_of(l.a, l.at_a), node_of(l.b, l.at_b)};
    joined[static_cast<std::size_t>(root(ends[i].from))] = root(ends[i].to);
  }
  std::map<int, Shared> points;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    points[root(static_cast<int>(n))].nodes.push_back(static_cast<int>(n));
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i].from >= 0) points[root(ends[i].from)].ties.push_back(static_cast<int>(i));

  for (auto& [unused, shared] : points) {
    const std::size_t s = shared.ties.size();
    if (s < 2 || shared.nodes.size() != s + 1 || s >= most_bodies) continue;
    const auto body = [&](int node) { return nodes[static_cast<std::size_t>(node)].body; };
    std::sort(shared.nodes.begin(), shared.nodes.end(),
              [&](int x, int y) { return body(x) < body(y); });
    if (std::adjacent_find(shared.nodes.begin(), shared.nodes.end(), [&](int x, int y) {
          return body(x) == body(y) ||
                 (body(x) >= 0 && root_of(parents, body(x)) == root_of(parents, body(y)));
        }) != shared.nodes.end())
      continue;
    const bool grounded = body(shared.nodes.front()) < 0;
    std::vector<Pair> given, paired;
    for (const int tie : shared.ties)
      given.push_back({place_in(shared.nodes, ends[static_cast<std::size_t>(tie)].from),
                       place_in(shared.nodes, ends[static_cast<std::size_t>(tie)].to)});
    for (int i = 0; i < static_cast<int>(s); ++i) paired.push_back({i + 1, grounded ? 0 : i});
    // Row r of the i-th pair stands at rows_[first + i · rows + r].
    const int first = static_cast<int>(rows_.size());
    const int rows = loops.loops[static_cast<std::size_t>(shared.ties[0])].rows;
    for (const int tie : shared.ties)
      for (int r = 0; r < rows; ++r)
        rows_.push_back(loops.loops[static_cast<std::size_t>(tie)].row + r);
    const auto add = [&](const std::vector<Pair>& from, const std::vector<Pair>& to,
                         std::vector<Term>& terms) {
      const auto ways = along(from, to, s + 1);
      for (std::size_t i = 0; i < ways.size(); ++i)
        for (const auto& [e, sign] : ways[i])
          for (int r = 0; r < rows; ++r)
            terms.push_back({first + e * rows + r, first + static_cast<int>(i) * rows + r, sign});
    };
    add(given, paired, given_);   // Φ' = T Φ, so σ = Tᵀσ'
    add(paired, given, paired_);  // Φ = S Φ'
    double least_scale = 0;
    for (const int tie : shared.ties)
      least_scale = std::max(least_scale, loops.loops[static_cast<std::size_t>(tie)].least_scale);
    for (std::size_t i = 0; i < s; ++i) {
      const Node &
          a = nodes[static_cast<std::size_t>(
             shared.nodes[static_cast<std::size_t>(paired[i].from)])],
         &b = nodes[static_cast<std::size_t>(shared.nodes[static_cast<std::size_t>(paired[i].to)])];
      auto& l = paired_anew.loops[static_cast<std::size_t>(shared.ties[i])];
      l.a = a.body;
      l.at_a = a.at;
      l.b = b.body;
      l.at_b = b.at;
      l.least_scale = least_scale;
    }
  }
  count_ = rows_.size();
  all_.resize(empty() ? 0 : static_cast<std::size_t>(loops.rows));
  before_.resize(rows_.size());
  for (auto* terms : {&given_, &paired_})
    std::stable_sort(terms->begin(), terms->end(),
                     [](const Term& x, const Term& y) { return x.to < y.to; });
}

void SharedPoints::exchange(const std::vector<Term>& terms, double* sigma, std::ptrdiff_t stride) {
  for (std::size_t i = 0; i < rows_.size(); ++i) before_[i] = sigma[rows_[i] * stride];
  auto t = terms.begin();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    double sum = 0;
    for (; t != terms.end() && static_cast<std::size_t>(t->to) == i; ++t)
      sum += t->sign * before_[static_cast<std::size_t>(t->from)];
    sigma[rows_[i] * stride] = sum;
  }
}

void SharedPoints::to_given(double* sigma, std::ptrdiff_t stride) {
  exchange(given_, sigma, stride);
}
const double* SharedPoints::to_paired(const double* sigma) {
  std::copy(sigma, sigma + all_.size(), all_.begin());
  exchange(paired_, all_.data(), 1);
  return all_.data();
}

SharedPoints::SharedPoints() = default;
SharedPoints::SharedPoints(const SharedPoints&) = default;
SharedPoints& SharedPoints::operator=(const SharedPoints&) = default;
SharedPoints::~SharedPoints() = default;

template SharedPoints::SharedPoints(const std::vector<int>&, const LoopModel<Planar>&,
                                    LoopModel<Planar>&);
template SharedPoints::SharedPoints(const std::vector<int>&, const LoopModel<Spatial>&,
                                    LoopModel<Spatial>&);

}  // namespace momenta
