#pragma once
// F and its total derivatives along a curve, and their derivatives by the curve's coefficients.
//
// Along y(t + s) = Σ y_k s^k, F(t + s) = Σ F_i s^i. Let A(s) = ∂F/∂y and B(s) = ∂F/∂y' along it. A
// change δy_j s^j of y changes F by (A(s) + B(s) j/s) s^j δy_j, so
//
//   ∂F_i/∂y_j = A_(i−j) + j B_(i−j+1).
//
// A and B come from F evaluated on series with two directions, exact to rounding.

#include <momenta/core/scalar/power_series.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// F(t, y, y') = 0 of `size` equations and unknowns, on curves: y, y' of one curve and F are arrays
/// of `size`.
struct CurveSystem {
  int size = 0;
  std::function<void(double t, const Jet* y, const Jet* ydot, Jet* r)> equations;
};

/// F_i, A_i and B_i of one curve, i = 0 … jet_order − 1.
struct CurveBlocks {
  /// `curve`: y_0 … y_(jet_order), one column each. O(size) evaluations of F
  CurveBlocks(const CurveSystem& system, double t, const Eigen::MatrixXd& curve);

  /// ∂F_i/∂y_j.
  Eigen::MatrixXd by(int i, int j) const;

  Eigen::MatrixXd f;                  ///< F_i, one column each
  std::vector<Eigen::MatrixXd> a, b;  ///< A_i, B_i
};

/// Scales rows and columns, but for rounding, to a largest entry near 1 (Ruiz 2001). @return the
/// column factors
Eigen::VectorXd equilibrate(Eigen::MatrixXd& matrix, Eigen::VectorXd& right);

// The differentiation index of F(t, y, y') = 0 at a consistent point, found from numbers.
//
// Along a solution y(t + s) = Σ y_k s^k, F(t + s) = Σ F_i s^i, the equations F_0 = … = F_ν = 0 are
// F and its first ν total derivatives: the derivative array. It is a system in the unknowns (y_1,
// …, y_(ν+1)), with y_1 = y', and has the matrix (measure/derivative_array.h)
//
//   G_ν:  ∂F_i/∂y_j = A_(i−j) + j B_(i−j+1),        i = 0 … ν,  j = 1 … ν + 1
//
// The index is the least ν for which the array determines y_1 as a function of (t, y): no vector of
// the kernel of G_ν has a part in y_1 (G_ν is 1-full). The array has (ν+1) N − rank G_ν constraints
// on (t, y) alone, given and hidden, when its rows are independent in all of (y, y_1, …).
//
// y_1 … come from Gauss-Newton on the array itself, from values of F alone. Ranks are read off
// singular values of the equilibrated matrix, and reported with their gap.
//
// Source: Campbell, Gear, The index of general nonlinear DAEs, Numer. Math. 72 (1995); Brenan,
// Campbell, Petzold, Numerical Solution of Initial-Value Problems in DAEs, chapter 2.

/// A rank with the smallest singular value that counts and the largest that does not, relative to
/// the largest (no less than rounding).
struct RankFound {
  int rank = 0;
  double kept = 0, dropped = 0;
  double gap() const { return kept / dropped; }
};

/// Cuts descending singular values at the largest ratio of neighbours. `largest`: scale of
/// rounding.
RankFound rank_by_gap(const Eigen::VectorXd& values, double largest);

/// The array after `differentiations`.
struct ArrayLevel {
  int differentiations = 0;
  int equations = 0, rank = 0;   ///< rows and rank of G_ν
  int constraints = 0;           ///< on (t, y) alone: equations − rank
  int undetermined = 0;          ///< directions of y' still free
  std::vector<bool> determined;  ///< by unknown: the array determines y'_i
  double gap = 0;                ///< smaller gap of the two ranks
  double residual = 0;           ///< |F_0 … F_ν| of the derivatives found, equilibrated
};

struct IndexFound {
  int index = -1;  ///< −1: y' is not determined after the last level, or a rank is not clear
  bool decided = false;
  std::string why;  ///< there is no index: one sentence
  std::vector<ArrayLevel> levels;
  std::vector<bool> appears;  ///< by unknown: F depends on y'_i; else algebraic
  Eigen::VectorXd ydot;       ///< y' of the last level
};

inline constexpr int most_differentiations = jet_order - 1;
inline constexpr double least_gap = 1e3;  ///< a rank with a smaller gap is not decided

/// `y`, `ydot`: a point with F(t, y, y') = 0 that meets the hidden constraints too; undetermined y'
/// may be a guess. `time_scale` [s]: about that of the motion.
/// Cost O(N) evaluations of F and, for each ν up to the index and each of a few corrections, an SVD
/// of ((ν+1) N)² entries.
IndexFound find_index(const CurveSystem& system, double t, const Eigen::VectorXd& y,
                      const Eigen::VectorXd& ydot, double time_scale,
                      int most = most_differentiations);

}  // namespace momenta
