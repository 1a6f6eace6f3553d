#pragma once
// Loop equations that the sweeps carry in space. Where every joint on a loop's cycle, but the one
// that carries the cycle's first body C, turns about one direction n or slides across it, all
// bodies of the cycle move in planes across n, as seen from C, in every pose:
//
//   ω_A − ω_B = w n,  ẋ_A − ẋ_B across n     (C taken for at rest)
//
//   D_j:  b_j ∥ n           is constant:  its row of Φ_q is zero
//   O_ij: a_i ∥ n or b_j ∥ n    likewise, (a_i × b_j)·n = 0
//
// Such a row says nothing and takes no impulse: σ = centre there, and the sweeps leave it out. A
// four-bar in space, or a leg's linkage on a robot that flies, closes by two equations, not by
// five. Joints that are driven move as others do.
//
// The axes of a ball's three rows may be anyhow. In axes b'_i = Σ_j R_ij b_j with b'_k = n they are
//
//   D' = R D,   σ = Rᵀ σ',   σ' = R σ        R constant, orthonormal
//
// the same equations, and D'_k is constant: a ball, too, closes by two. k is the axis nearest to
// n; the three rows are softened alike, so that R leaves that alone.
//
// A loop's own drive that turns its axes may leave the plane: such loops are carried whole.

#include <momenta/dae/mechanism/loop/loop_model.h>

#include <cstddef>

namespace momenta {

/// The rows of Φ that stay, and multipliers between both numberings.
class CarriedRows {
 public:
  // Out of line: the sweeps that copy them are compiled for several instruction levels.
  CarriedRows();
  CarriedRows(const CarriedRows&);
  CarriedRows& operator=(const CarriedRows&);
  ~CarriedRows();
  /// Takes out of `loops` the rows that are zero in every pose; those that stay are numbered anew.
  /// O(length of all loops).
  CarriedRows(const Tree& tree, const Model<Spatial>& model, LoopModel<Spatial>& loops);

  bool all() const { return left_out_.empty(); }
  /// Rows of Φ left out; of a ball the row nearest to what is left out.
  const std::vector<int>& left_out() const { return left_out_; }
  /// Row of Φ that the sweeps number `carried`.
  int given(int carried) const;
  /// Spreads σ of the carried rows from the first places of `sigma` to all m, in place; components
  /// `stride` apart. Rows left out have σ of `centre` (m); null: zero.
  void to_given(double* sigma, std::ptrdiff_t stride, const double* centre = nullptr) const;
  /// σ' of the carried rows from σ (m); valid until the next call.
  const double* to_carried(const double* sigma);
  /// The numbers of carried rows out of m, alike for the rows of a ball; valid until the next call.
  const double* of_carried(const double* x);

 private:
  /// A ball whose three rows, from `first` on, stand along other axes.
  struct Turned {
    int first, nearest;  ///< rows of Φ: the first, and that of k
    Eigen::Matrix3d R;
  };
  std::vector<int> rows_, left_out_;
  std::vector<Turned> turned_;
  std::vector<double> impulses_, numbers_;
};

}  // namespace momenta
