#pragma once
// Which loop equations the sweeps carry in space. Where every joint on a loop's cycle, but the one
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
// five. Joints that are driven move as others do. What turns the axes of a loop's own drive may
// leave the plane: such loops are carried whole.

#include <momenta/dae/loop/loop_model.h>

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

  /// Whether all rows are carried.
  bool all() const { return left_out_.empty(); }
  /// Of Φ, the rows that are left out.
  const std::vector<int>& left_out() const { return left_out_; }
  /// Of Φ, the row that the sweeps number so.
  int given(int carried) const;
  /// σ of the carried rows, in the first places of `sigma`, to all m places, in place; components
  /// `stride` apart. Of rows left out σ is that of `centre` (m); null: zero.
  void to_given(double* sigma, std::ptrdiff_t stride, const double* centre = nullptr) const;
  /// Of m numbers, those of carried rows, until the next call with the same `place`.
  const double* to_carried(const double* x, int place);

 private:
  std::vector<int> rows_, left_out_;
  std::vector<double> places_[2];
};

}  // namespace momenta
