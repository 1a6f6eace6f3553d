#pragma once
// The values of (7) with their factors: a row of Φ fades relative to the scale of its group.

#include <momenta/dae/factor/axis_scale.h>
#include <momenta/dae/factor/filtered_factor.h>

#include <vector>

namespace momenta {

class FilteredMatrix {
 public:
  /// `groups` (m): Mechanism::row_groups; it and the pattern are kept by reference.
  FilteredMatrix(const KktPattern& pattern, AxisScale scale, int nv,
                 const std::vector<int>& groups);

  double* mass() { return mass_.data(); }              ///< to be written, in the pattern's order
  double* constraint() { return constraint_.data(); }  ///< likewise

  /// Factorises with E (m), with which no row fades (null: 0), and `fade`, how weak a pivot may be
  /// relative to its group's scale. False where a scale is not finite, or as
  /// FilteredFactor::factor(). O(fill), no allocation.
  bool factor(const double* compliance, double fade);

  const FilteredFactor& factors() const { return factor_; }
  void solve(double* x) { factor_.solve(x); }  ///< x (nv + m) ← A⁻¹ x
  /// Pivot below which each row (m) fades in the last factor(); 0: it does not.
  const std::vector<double>& fading() const { return tau_; }

 private:
  AxisScale scale_;
  MassDiagonal diagonal_of_mass_;
  FilteredFactor factor_;
  std::vector<double> mass_, constraint_, tau_;
};

}  // namespace momenta
