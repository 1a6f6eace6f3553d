#pragma once
// The matrix of (7) as L D Lᵀ, sparse, pivots of σ filtered: dense_kkt.cpp with a sparse pattern.
//
//   ( M    Φ_qᵀ )        each u before its ancestors and before the loops that hold it,
//   ( Φ_q  −E   )        each loop's rows as soon as all their joints have gone
//
// In that order every pivot of u is an articulated inertia, positive, and every pivot of σ is −w, w
// a Schur complement of Φ_q M⁻¹ Φ_qᵀ among the rows not closed before: no pivot has to be sought
// among others for size. Rows of one loop go the largest remaining w first, its size taken relative
// to where the row fades. w is inverted as f(w) = w³/(w⁴ + τ⁴) (front.h), each column used as it
// stands when its pivot goes:
//
//   A_ab −= c_a f c_b,        x = Σ f c (cᵀ …).
//
// Fill: of a joint its ancestors and the loops open there. Among loops that close at one depth the
// order is AMD's. Left-looking, block columns: a joint's coordinate, or the rows of a loop.
// Source: Davis, Direct Methods for Sparse Linear Systems, ch. 4; Amestoy, Davis, Duff, ACM TOMS 30
// (2004) 381, for the order.

#include <momenta/dae/mechanism/kkt_pattern.h>

#include <vector>

namespace momenta {

class FilteredFactor {
 public:
  /// `nv` columns of M; `groups` (m): Mechanism::row_groups. The pattern is kept by reference.
  FilteredFactor(const KktPattern& pattern, int nv, const std::vector<int>& groups);

  /// Factorises M and Φ_q, in the order of the KKT pattern, with E (m, null: 0) and τ (m, 0: no
  /// filter). False where a pivot of u, at place singular_joint(), is not positive or not finite.
  /// O(fill), no allocation.
  bool factor(const std::vector<double>& mass, const std::vector<double>& constraint,
              const double* compliance, const double* tau);
  /// x (nv + m) ← A⁻¹ x.
  void solve(double* x);

  int singular_joint() const { return singular_joint_; }
  /// w of each row of Φ (m) when it was closed.
  const std::vector<double>& pivots() const { return pivot_; }
  long entries() const { return static_cast<long>(value_.size()); }

 private:
  /// A block of columns: its unknowns, the rows below them, and where their values begin.
  struct Block {
    int first = 0, last = 0;       ///< columns, in the order of elimination
    std::size_t row = 0, end = 0;  ///< into row_: the block's own, then those below
    std::size_t value = 0;         ///< into value_, column by column
    bool loop = false;
    int size() const { return last - first; }
    std::size_t height() const { return end - row; }
  };
  void order(const std::vector<int>& groups);
  void analyse();
  bool eliminate(const Block& block, const double* tau);
  void update(const Block& from, std::size_t at, const Block& to);

  const KktPattern& pattern_;
  int n_, m_, singular_joint_ = -1;
  std::vector<int> place_;    ///< place of each unknown in the order of elimination
  std::vector<int> unknown_;  ///< its inverse
  std::vector<Block> blocks_;
  std::vector<int> block_of_;    ///< per column in the order of elimination
  std::vector<int> row_;         ///< in the order of elimination, ascending
  std::vector<double> value_;    ///< columns as they stood when eliminated
  std::vector<double> inverse_;  ///< per column: 1/d, −f(w)
  std::vector<int> turn_;        ///< per column of a block: the one that goes in that turn
  std::vector<std::size_t> mass_at_, constraint_at_, diagonal_at_;
  std::vector<int> where_;        ///< row → place in the block under way
  std::vector<int> head_, next_;  ///< blocks whose next rows are in a block
  std::vector<std::size_t> reached_;
  std::vector<double> pivot_, work_;
};

}  // namespace momenta
