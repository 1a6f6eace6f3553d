#pragma once
// How large rows that tie axes are by nature. Where all hinges of a loop are parallel, the
// equations for its axes vanish to rounding in every entry: they are redundant, not weak, and what
// is left of them is no scale for anything.

#include <momenta/dae/mechanism.h>

#include <vector>

namespace momenta {

class AxisScale {
 public:
  explicit AxisScale(const Mechanism& mechanism);

  /// Per row (m): Σ_j 1/M_jj over the rotations that an axis row hangs on, whose entries are at
  /// most 1: its W_ii when the axes are anyhow; the mechanism's least scale for rows of points and
  /// distances. `mass`: values
  /// of M in the order of the KKT pattern.
  void measure(const std::vector<double>& mass, std::vector<double>& scale) const;
  /// Per row (m) the mean over the rows of its group of max(Σ_j Φ_ij² / M_jj, the above);
  /// `constraint`: values of Φ_q in the order of the pattern.
  void of_groups(const std::vector<double>& mass, const std::vector<double>& constraint,
                 std::vector<double>& scale) const;

 private:
  struct Hanging {
    std::size_t row, mass;  ///< row of Φ, place of M_jj among the values
  };
  const KktPattern& pattern_;
  const std::vector<int>& groups_;
  const std::vector<double>& least_;
  std::vector<std::size_t> diagonal_;  ///< place of M_jj among the values (nv)
  std::vector<Hanging> hanging_;
};

/// Scale of each row of Φ_q M⁻¹ Φ_qᵀ (m) at the configuration placed in `e`: the mean of Σ_j Φ_ij²
/// / M_jj over the rows of its group, since a row may vanish in every entry; where a whole group of
/// axis rows does, what is natural for them. [1/kg, or 1/(kg m²)]
std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
