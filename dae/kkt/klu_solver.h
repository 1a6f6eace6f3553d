#pragma once
// (7), the last m of its equations Φ_q u − ε (σ − centre) = g, factorised by KLU. Pivots are sought
// among all unknowns, σ may go before u, so there is no single pivot of a row of Φ to fade: −ε
// stands in place of 0, ε about fade times the scale of Φ_q M⁻¹ Φ_qᵀ, recentred, so that a regular
// row is off by ε (σ − centre) only, and a redundant or vanishing row keeps its impulse. On regular
// rows recentring takes that away.
//
// The pattern is analysed once, pivots are chosen once and then kept as long as the entries do not
// grow on them (klu_rgrowth). Every solution is refined against its residual, which is what says
// whether it is one: where it does not come down to rounding, pivots are chosen anew, and where it
// still does not, there is no solution.
// Source: Davis, Palamadai Natarajan, ACM TOMS 37 (2010) 36.

#include <momenta/dae/kkt/symmetric_matrix.h>
#include <suitesparse/klu.h>

#include <vector>

namespace momenta {

class KluSolver {
 public:
  /// blocks: BTF and AMD, for pivots mostly on the diagonal; columns: COLAMD, whose fill is bounded
  /// for any pivots. Of the bodies' equations half the diagonal is zero.
  enum class Order { blocks, columns };
  /// `soft`: how many of the last unknowns are σ.
  KluSolver(int size, int soft, const std::vector<KktPattern::Entry>& entries, Order order);
  ~KluSolver();
  KluSolver(const KluSolver&) = delete;
  KluSolver& operator=(const KluSolver&) = delete;

  /// To be filled before factor(), but for the diagonal of σ.
  SymmetricMatrix& matrix() { return matrix_; }
  /// Factorises with ε (soft). False where an entry is not finite or no pivot is found:
  /// singular_column().
  bool factor(const std::vector<double>& epsilon);
  /// x (size) ← A⁻¹ x; `centre` (soft, null: zero). With `is_model` ε is part of the equations, and
  /// is not refined away. False where the residual does not reach rounding.
  bool solve(double* x, const double* centre, bool is_model);

  int singular_column() const { return singular_; }
  /// The smallest pivot over the largest, of the last factor(); 0 where there is none.
  double pivot_ratio();
  /// Nonzeros of L and U.
  long entries() const { return numeric_ ? numeric_->lnz + numeric_->unz : 0; }
  /// Pivots chosen so far.
  long choices() const { return choices_; }

 private:
  bool factor_anew();
  bool attempt(const double* centre, bool is_model);

  SymmetricMatrix matrix_;
  std::size_t hard_;  ///< unknowns before σ
  std::vector<double> epsilon_, centre_, given_, b_, x_, r_;
  int singular_ = -1;
  double fresh_ = 0;  ///< reciprocal growth of the entries on pivots just chosen
  long choices_ = 0;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace momenta
