#pragma once
// Choice of the edges of a mechanism's graph that are joints of its tree. Vertices are the
// bodies and the ground, 0; every loop e has one cycle, e and the way through the tree between its
// ends, and is open in the front of a joint j exactly when j is on that cycle. With k_j the number
// of equations open at j, what the sweeps pay for loops is
//
//   J = Σ_j k_j²                                       (LoopPlan::work, but for the closing bodies)
//
// whatever body is the root. e may change places with any joint f of its cycle: e becomes a joint,
// f a loop. Of the cycles only those that pass f change, and those by the cycle of e,
//
//   C_g ← C_g + C_e (mod 2) for g through f,     C_f = C_e,
//
// so that J changes along C_e alone. descend() exchanges as long as J falls: a local minimum. (The
// least sum of lengths over all trees is NP-hard: Deo, Prabhu, Krishnamoorthy, ACM TOMS 8 (1982)
// 26.) balance() moves cuts on where that costs nothing, to where the two ways to the ground are
// equally long: every body of the cycle is then as near to the ground as the cycle allows, Σ depth
// falls, and with it the entries of M.

#include <cstdint>
#include <vector>

namespace momenta {

struct CutEdge {
  int a = 0, b = 0;  ///< vertices
  int rows = 0;      ///< its equations as a loop
  bool in_tree = false;
  bool fixed = false;  ///< stays a joint or a loop
  bool operator==(const CutEdge&) const = default;
};

class Cycles {
 public:
  /// @pre The edges in the tree span all vertices. O(vertices + length of all cycles).
  Cycles(int vertices, std::vector<CutEdge> edges);

  const std::vector<CutEdge>& edges() const { return edges_; }
  std::int64_t work() const { return work_; }  ///< J
  std::int64_t depth() const;                  ///< Σ over the bodies of joints to the ground

  /// Change of J when loop e and joint f change places. O(length of the cycle · loops on it).
  /// @pre f is on the cycle of e
  std::int64_t gain(int e, int f);
  void exchange(int e, int f);

  /// Exchanges as long as J falls, the best of each loop in turn; `effort` bounds what gain() looks
  /// at. Returns the effort left, 0 where the descent was cut short.
  std::int64_t descend(std::int64_t effort);
  std::int64_t balance(std::int64_t effort);

  /// The joints of the cycle of loop e.
  const std::vector<int>& cycle(int e) const { return cycle_[static_cast<std::size_t>(e)]; }

 private:
  bool may_change(int e, int f) const;
  std::int64_t open(const std::vector<int>& loops) const;

  std::vector<CutEdge> edges_;
  std::vector<int> parent_edge_;           ///< per vertex, −1 of the ground
  std::vector<std::vector<int>> cycle_;    ///< per loop: its joints
  std::vector<std::vector<int>> through_;  ///< per joint: loops on whose cycle it is, ascending
  std::int64_t work_ = 0, looked_at_ = 0;
  std::vector<int> scratch_;
};

/// Σ over the loops of joints on their cycles, at most `most` + 1. O(vertices + most).
std::int64_t length_of_cycles(int vertices, const std::vector<CutEdge>& edges, std::int64_t most);

/// The edges with a shallow tree: fixed joints, then the edges of most equations, the nearest to
/// the ground first.
std::vector<CutEdge> shallow_tree(int vertices, const std::vector<CutEdge>& edges);

/// The edges with a deep tree: from each vertex on to the neighbour that most edges tie to the way
/// there, back where there is none. In a band, such as a ladder, cycles are then short where those
/// of a shallow tree are as long as the band.
std::vector<CutEdge> deep_tree(int vertices, const std::vector<CutEdge>& edges);

}  // namespace momenta
