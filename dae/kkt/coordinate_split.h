#pragma once
// Coordinate partitioning of a constraint Jacobian A (rows × columns): rank(A) independent rows and
// as many dependent columns, chosen by LU with full pivoting so that the block A_d where they cross
// is as regular as can be; the other columns are the independent coordinates. Then
//
//   ∂x_d/∂x_i = −A_d⁻¹ A_i
//
// and rows that were not chosen follow from those that were. Columns are weighed by the root of
// their own inertia: entries of A are compared per root of energy, not per rad or m, and light
// coordinates depend on heavy ones.

#include <momenta/dae/mechanism/mechanism.h>
#include <suitesparse/klu.h>

#include <Eigen/Dense>
#include <memory>
#include <vector>

namespace momenta {

class CoordinateSplit {
 public:
  /// Places of the entries of A, and the weight of each column.
  CoordinateSplit(std::vector<KktPattern::Entry> pattern, int rows, Eigen::VectorXd weights);

  /// Chooses for the entries `values`. `rank` < 0: the number of pivots above 1e-9 of the largest;
  /// else that many, and false when the last one is not above 1e-9. Cost O(rows · columns · rank).
  bool choose(const std::vector<double>& values, int rank = -1);

  int row_count() const { return row_count_; }
  int rank() const { return static_cast<int>(dependent_.size()); }
  const std::vector<KktPattern::Entry>& pattern() const { return pattern_; }
  const std::vector<int>& rows() const { return rows_; }                ///< chosen, rank() of them
  const std::vector<int>& dependent() const { return dependent_; }      ///< columns, rank() of them
  const std::vector<int>& independent() const { return independent_; }  ///< the others, ascending
  const Eigen::VectorXd& weights() const { return weights_; }

 private:
  std::vector<KktPattern::Entry> pattern_;
  Eigen::VectorXd weights_;
  int row_count_;
  std::vector<int> rows_, dependent_, independent_;
};

/// The block A_d of one choice, factorised: dense LU, above 40 rows KLU on a pattern analysed once.
class SplitFactor {
 public:
  explicit SplitFactor(const CoordinateSplit& split);
  ~SplitFactor();
  SplitFactor(const SplitFactor&) = delete;
  SplitFactor& operator=(const SplitFactor&) = delete;

  /// Factorises from the entries of A; false where the block is singular.
  bool factor(const std::vector<double>& values);
  /// x (rank) ← A_d⁻¹ of the chosen rows of `right` (rows).
  void solve(const Eigen::VectorXd& right, Eigen::VectorXd& x);
  /// Largest |∂x_d/∂x_i|, weighed: how much the dependent coordinates magnify the independent ones.
  double growth(const std::vector<double>& values);

 private:
  const CoordinateSplit& split_;
  bool sparse_;
  std::vector<int> place_;  ///< place of each entry in the block's values, or −1
  Eigen::MatrixXd block_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::VectorXd right_, column_, slopes_;
  std::vector<int> start_, row_;
  std::vector<double> value_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace momenta
