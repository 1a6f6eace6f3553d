#pragma once
// Natural sizes of rows that tie axes. Where all hinges of a loop are parallel, the equations for
// its axes vanish to rounding in every entry: they are redundant, not weak, and their remains are
// no scale.

#include <momenta/dae/mechanism/mechanism.h>

#include <vector>

namespace momenta {

/// Gives rows without a scale the largest one: those on which no inertia hangs, of a loop between
/// welded bodies or the axes of a slide on a slide, where any positive scale does.
void scale_idle_rows(std::vector<double>& scale);

class AxisScale {
 public:
  /// Keeps the mechanism's Φ_q pattern, row groups and least scales by reference.
  explicit AxisScale(const Mechanism& mechanism);

  /// Share of its scale below which a pivot fades, where masses are apart: fade_beside().
  double fading(double fade) const;

  /// Per row (m): Σ_j 1/M_jj over the rotations that an axis row hangs on, whose entries are at
  /// most 1: its W_ii at axes in general position; the least scale for rows of points and
  /// distances. `inertia`: M_jj (nv).
  void measure(const std::vector<double>& inertia, std::vector<double>& scale) const;
  /// Per row (m) the mean over the rows of its group of max(Σ_j Φ_ij² / M_jj, measure());
  /// `constraint`: values of Φ_q in the order of the pattern.
  void of_groups(const std::vector<double>& inertia, const std::vector<double>& constraint,
                 std::vector<double>& scale) const;
  /// Pivot below which each row (m) fades, fading(fade) of of_groups(); 0 for all where there is a
  /// compliance. False where a scale is not finite. No allocation.
  bool fade_groups(const std::vector<double>& inertia, const std::vector<double>& constraint,
                   const double* compliance, double fade, std::vector<double>& tau) const;
  /// ε of KluSolver (m), from the same. An added block, once refined, costs (ε/W)² on every row: so
  /// it is a hundred times weaker than the filter of pivots, which costs (τ/W)⁴. The scale is a
  /// row's mobility by the lightest body of its loop; beyond masses_far_apart the heaviest's is
  /// still above ε.
  void softness(const std::vector<double>& inertia, const std::vector<double>& constraint,
                double fade, std::vector<double>& epsilon) const;

 private:
  struct Hanging {
    std::size_t row, rate;  ///< row of Φ, j
  };
  const std::vector<KktPattern::Entry>& pattern_;  ///< pattern of Φ_q
  const std::vector<int>& groups_;
  const std::vector<double>& least_;
  double far_apart_;  ///< mass spread over masses_far_apart, at least 1
  double apart_;      ///< LoopWeights::apart
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

}  // namespace momenta
