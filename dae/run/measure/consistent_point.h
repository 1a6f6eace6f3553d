#pragma once
// A point (y, y') near a guess that meets F(t, y, y') = 0 and its hidden constraints.
//
// F_0 = … = F_ν = 0 of the derivative array, solved for y and y_1 … y_(ν+1): with J_0 = ∂F/∂y_0 and
// J_+ = ∂F/∂(y_1 …) a Newton correction has J_0 δ_0 + J_+ δ_+ = −F. N, whose rows span the left
// null space of J_+, leaves the constraints on y alone,
//
//   N J_0 δ_0 = −N F,
//
// and δ_0 is their solution of least size, in units of each unknown's scale; then δ_+ is the least
// one. An unknown of scale 0 keeps its guess. One of infinite scale, such as a multiplier, follows
// from the others and stands with y_1, …, not with least-changed unknowns. ν rises from 0 until the
// index is found at the point: more differentiation gives no more equations for y.

#include <momenta/dae/run/measure/derivative_array.h>

#include <memory>
#include <string>

namespace momenta {

/// One Newton correction of y_0 … y_(ν+1).
class CurveCorrection {
 public:
  /// `scale` by unknown; 0: held, infinite: free. O((ν n)³)
  CurveCorrection(const CurveBlocks& at, int nu, double time_scale, const Eigen::VectorXd& scale);
  ~CurveCorrection();

  /// δ(y_0 … y_(ν+1)), one column each, for F_0 … F_ν, one column each.
  Eigen::MatrixXd of(const Eigen::MatrixXd& f) const;
  /// Largest of F_0 … F_ν, relative to each row's largest entry.
  double size(const Eigen::MatrixXd& f) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

struct ConsistentPoint {
  Eigen::VectorXd y, ydot;
  IndexFound found;          ///< the index there
  int differentiations = 0;  ///< ν at the point
  std::string why;           ///< reason for failure, one sentence; empty: the point is consistent
};

/// Starts at a guess of y and y'. Cost of find_index() and for each ν a few corrections, each a
/// decomposition of ((ν+1) n)² entries.
ConsistentPoint consistent_point(const CurveSystem& system, double t, const Eigen::VectorXd& y,
                                 const Eigen::VectorXd& ydot, const Eigen::VectorXd& scale,
                                 double time_scale);

}  // namespace momenta
