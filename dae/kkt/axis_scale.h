#pragma once
// How large rows are by nature, not as they are. Where all hinges of a loop are parallel, the
// equations for its axes vanish to rounding in every entry: they are redundant, not weak, and what
// is left of them is no scale for anything. So do equations for a point that the tree grants by
// itself, of a slide along a cylindrical joint for instance.

#include <momenta/dae/mechanism.h>

#include <vector>

namespace momenta {

class AxisScale {
 public:
  explicit AxisScale(const Mechanism& mechanism);

  /// Per row (m): Σ_j 1/M_jj over the rotations that an axis row hangs on, whose entries are at
  /// most 1: its W_ii when the axes are anyhow. Of a row of points or a distance 1e-16 of the same
  /// with arms as long as the scene: far below what any row weighs that is not rounding, far above
  /// the 1e-32 of one that is. `mass`: values of M in the order of the KKT pattern.
  void measure(const std::vector<double>& mass, std::vector<double>& scale) const;

 private:
  struct Hanging {
    std::size_t row, mass;  ///< row of Φ, place of M_jj among the values
    double arm2;            ///< square of the largest entry there may be, or 1e-16 of it
  };
  std::vector<Hanging> hanging_;
};

/// Scale of each row of Φ_q M⁻¹ Φ_qᵀ (m) at the configuration placed in `e`: the mean of Σ_j Φ_ij²
/// / M_jj over the rows of its group, since a row may vanish in every entry; where a whole group of
/// axis rows does, what is natural for them. [1/kg, or 1/(kg m²)]
std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
