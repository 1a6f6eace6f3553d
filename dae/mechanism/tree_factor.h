#pragma once
// M = Lᵀ D L along the tree, tips first: L has an entry only where one joint carries the other, so
// nothing fills in and the cost is Σ depth² instead of n³ (Featherstone, Rigid Body Dynamics
// Algorithms, 6.5).

#include <momenta/dae/mechanism/kkt_pattern.h>

#include <vector>

namespace momenta {

class TreeFactor {
 public:
  TreeFactor(const KktPattern& pattern, int nv);

  /// Factorises M from its values in the order of the pattern. Returns −1, or the place in u at
  /// which M is not positive.
  int factor(const std::vector<double>& mass);

  /// x ← L⁻ᵀ x (nv): momenta inward, tips to root. Zeros at the tips cost nothing.
  void inward(double* x) const {
    for (std::size_t k = start_.size() - 1; k-- > 0;) {
      const double from = x[k];
      if (from == 0) continue;
      for (std::size_t i = start_[k] + 1; i < start_[k + 1]; ++i) x[row_[i]] -= value_[i] * from;
    }
  }
  /// x ← L⁻¹ x (nv): rates outward, root to tips.
  void outward(double* x) const {
    for (std::size_t k = 0; k + 1 < start_.size(); ++k) {
      double sum = x[k];
      for (std::size_t i = start_[k] + 1; i < start_[k + 1]; ++i) sum -= value_[i] * x[row_[i]];
      x[k] = sum;
    }
  }
  /// D⁻¹ (nv).
  const std::vector<double>& inverse_pivots() const { return inverse_; }

 private:
  std::vector<std::size_t> start_;  ///< per column: itself, then its ancestors, nearest first
  std::vector<std::size_t> row_;
  std::vector<double> value_;
  std::vector<std::size_t> place_;  ///< place of each pattern entry in value_
  std::vector<double> inverse_;
  std::vector<double> diagonal_;  ///< M_kk
};

}  // namespace momenta
