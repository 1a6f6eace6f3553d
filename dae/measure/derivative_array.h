#pragma once
// The differentiation index of F(t, y, y') = 0 at a consistent point, found from numbers.
//
// Along a solution y(t + s) = Σ y_k s^k, F(t + s) = Σ F_i s^i, the equations F_0 = … = F_ν = 0 are
// F and its first ν total derivatives: the derivative array. It is a system in the unknowns (y_1,
// …, y_(ν+1)), with y_1 = y', and has the matrix (measure/curve_blocks.h)
//
//   G_ν:  ∂F_i/∂y_j = A_(i−j) + j B_(i−j+1),        i = 0 … ν,  j = 1 … ν + 1
//
// The index is the least ν for which the array determines y_1 as a function of (t, y): no vector of
// the kernel of G_ν has a part in y_1 (G_ν is 1-full). What the array says of (t, y) alone are its
// constraints, given and hidden: (ν+1) N − rank G_ν of them, when its rows are independent in all
// of (y, y_1, …).
//
// y_1 … come from Gauss-Newton on the array itself, so that nothing need be known of F but its
// values. Ranks are read off singular values of the equilibrated matrix, and told with their gap.
//
// Source: Campbell, Gear, The index of general nonlinear DAEs, Numer. Math. 72 (1995); Brenan,
// Campbell, Petzold, Numerical Solution of Initial-Value Problems in DAEs, chapter 2.

#include <momenta/dae/measure/curve_blocks.h>

#include <string>
#include <vector>

namespace momenta {

/// A rank with what speaks for it: the smallest singular value that counts and the largest that
/// does not, over the largest of all (no less than rounding).
struct RankFound {
  int rank = 0;
  double kept = 0, dropped = 0;
  double gap() const { return kept / dropped; }
};

/// Cuts descending singular values where the ratio of neighbours is largest. `largest`: the value
/// rounding is measured against.
RankFound rank_by_gap(const Eigen::VectorXd& values, double largest);

/// The array after `differentiations`.
struct ArrayLevel {
  int differentiations = 0;
  int equations = 0, rank = 0;   ///< rows of G_ν, and its rank
  int constraints = 0;           ///< on (t, y) alone: equations − rank
  int undetermined = 0;          ///< directions of y' still free
  std::vector<bool> determined;  ///< whether the array determines y'_i, for each unknown
  double gap = 0;                ///< the smaller of the two ranks' gaps
  double residual = 0;           ///< |F_0 … F_ν| of the derivatives found, equilibrated
};

struct IndexFound {
  int index = -1;  ///< −1: y' is not determined after the last level, or a rank is not clear
  bool decided = false;
  std::string why;  ///< one sentence when there is no index
  std::vector<ArrayLevel> levels;
  std::vector<bool> appears;  ///< whether y'_i stands in F; the others are algebraic unknowns
  Eigen::VectorXd ydot;       ///< y' that meets the last level
};

inline constexpr int most_differentiations = jet_order - 1;
inline constexpr double least_gap = 1e3;  ///< below it a rank is not decided

/// `y`, `ydot`: a point with F(t, y, y') = 0 that meets the hidden constraints too; of y' a guess
/// will do where it is not determined. `time_scale` [s]: about that of the motion.
/// Cost O(N) evaluations of F and an SVD of ((ν+1) N)² entries for each ν up to the index and each
/// correction of the derivatives, a few.
IndexFound find_index(const CurveSystem& system, double t, const Eigen::VectorXd& y,
                      const Eigen::VectorXd& ydot, double time_scale,
                      int most = most_differentiations);

}  // namespace momenta
