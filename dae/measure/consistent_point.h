#pragma once
// A point (y, y') near a guess that meets F(t, y, y') = 0 and its hidden constraints.
//
// F_0 = … = F_ν = 0 of the derivative array, solved for y as well as for y_1 … y_(ν+1): with
// J_0 = ∂F/∂y_0 and J_+ = ∂F/∂(y_1 …) a Newton correction has J_0 δ_0 + J_+ δ_+ = −F. Multiplied by
// N, whose rows span the left null space of J_+, what is left are the constraints on y alone,
//
//   N J_0 δ_0 = −N F,
//
// and δ_0 is their solution of least size, in units of each unknown's scale; then δ_+ is the least
// one. An unknown of scale 0 stays as it was guessed. One of infinite scale, such as a multiplier,
// is found from the others and stands with y_1, …, not with those that are to change least. ν rises
// from 0 until the index is found at the point: then no further differentiation says anything more
// of y.

#include <momenta/dae/measure/derivative_array.h>

#include <memory>
#include <string>

namespace momenta {

/// One Newton correction of y_0 … y_(ν+1).
class CurveCorrection {
 public:
  /// `scale`: of each unknown, 0: held, infinite: free. O((ν n)³)
  CurveCorrection(const CurveBlocks& at, int nu, double time_scale, const Eigen::VectorXd& scale);
  ~CurveCorrection();

  /// δ(y_0 … y_(ν+1)), one column each, for F_0 … F_ν, one column each.
  Eigen::MatrixXd of(const Eigen::MatrixXd& f) const;
  /// The largest of F_0 … F_ν, in units of the largest entry of each row.
  double size(const Eigen::MatrixXd& f) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

struct ConsistentPoint {
  Eigen::VectorXd y, ydot;
  IndexFound found;          ///< the index there
  int differentiations = 0;  ///< ν that gave the point
  std::string why;           ///< one sentence where there is none; empty: the point is consistent
};

/// From a guess of y and y'. Cost of find_index() and one decomposition of ((ν+1) n)² entries for
/// each correction, a few for each ν.
ConsistentPoint consistent_point(const CurveSystem& system, double t, const Eigen::VectorXd& y,
                                 const Eigen::VectorXd& ydot, const Eigen::VectorXd& scale,
                                 double time_scale);

}  // namespace momenta
