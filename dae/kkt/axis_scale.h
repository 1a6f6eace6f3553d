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
  /// distances. `inertia`: M_jj (nv).
  void measure(const std::vector<double>& inertia, std::vector<double>& scale) const;
  /// Per row (m) the mean over the rows of its group of max(Σ_j Φ_ij² / M_jj, the above);
  /// `constraint`: values of Φ_q in the order of the pattern.
  void of_groups(const std::vector<double>& inertia, const std::vector<double>& constraint,
                 std::vector<double>& scale) const;
  /// ε of KluSolver (m), from the same. An added block, once refined, costs (ε/W)² on every row: so
  /// it is a hundred times weaker than the filter of pivots, which costs (τ/W)⁴. The scale is what
  /// the lightest body of a loop lets a row move; where masses are further apart than
  /// masses_far_apart, the heaviest's is still above ε.
  void softness(const std::vector<double>& inertia, const std::vector<double>& constraint,
                double fade, std::vector<double>& epsilon) const;

 private:
  struct Hanging {
    std::size_t row, rate;  ///< row of Φ, j
  };
  const std::vector<KktPattern::Entry>& pattern_;  ///< of Φ_q
  const std::vector<int>& groups_;
  const std::vector<double>& least_;
  double far_apart_;  ///< mass spread over masses_far_apart, at least 1
  std::vector<Hanging> hanging_;
};

/// M_jj out of the values of M.
class MassDiagonal {
 public:
  MassDiagonal(const KktPattern& pattern, int nv);
  const std::vector<double>& of(const std::vector<double>& mass);

 private:
  std::vector<std::size_t> place_;
  std::vector<double> inertia_;
};

/// Scale of each row of Φ_q M⁻¹ Φ_qᵀ (m) at the configuration placed in `e`: the mean of Σ_j Φ_ij²
/// / M_jj over the rows of its group, since a row may vanish in every entry; where a whole group of
/// axis rows does, what is natural for them. [1/kg, or 1/(kg m²)]
std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
