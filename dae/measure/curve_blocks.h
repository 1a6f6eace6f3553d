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

}  // namespace momenta
