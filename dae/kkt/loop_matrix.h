#pragma once
// W = Φ_q M⁻¹ Φ_qᵀ = Σ l_k d_k l_kᵀ by scalar eliminations, largest remaining diagonal first: what
// is left of the loops once the bodies are eliminated, by whatever factors of M.
//
// Each pivot is inverted as f(d) = d³/(d⁴ + τ⁴), zero for d ≤ 0: exact to (τ/d)⁴ above τ, fading to
// zero below. Solved around a centre, σ = centre + σ', only σ' fades, so a faded row keeps the
// impulse it had at the step's start.

#include <momenta/dae/mechanism/mechanism.h>

#include <vector>

namespace momenta {

class LoopMatrix {
 public:
  explicit LoopMatrix(const Mechanism& mechanism);

  /// W_ij, j ≤ i, to be written before eliminate().
  double& at(int i, int j) { return w_[place(i, j)]; }
  /// `natural`: what rows that tie axes are at least (m), see axis_scale.h. `compliance` (m): added
  /// to the diagonal, and no row fades; null: τ = fade times the mean diagonal of the row's group.
  /// False when an entry is not finite. O(m³).
  bool eliminate(double fade, const double* natural, const double* compliance);
  /// W σ = d; d is spoilt. O(m²).
  void solve(double* d, double* sigma) const;
  /// Rows whose pivots faded at the last eliminate().
  const std::vector<int>& faded_rows() const { return faded_rows_; }
  /// The weakest pivot that did not fade, over the mean diagonal of its row's group; 1 at most.
  double weakest() const { return weakest_; }

 private:
  std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(m_) + static_cast<std::size_t>(j);
  }
  static std::size_t idx(int i) { return static_cast<std::size_t>(i); }

  const std::vector<int>& groups_;
  int m_;
  std::vector<double> w_;  ///< m × m, its columns as they stood when eliminated
  std::vector<double> inverse_, tau_, group_sum_;
  std::vector<int> order_, group_rows_, faded_rows_;
  double weakest_ = 1;
};

}  // namespace momenta
