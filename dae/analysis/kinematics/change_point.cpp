#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/analysis/kinematics/change_point.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double near_by = 0.3;     // distance of a change point [units]
constexpr double seems_lost = 0.2;  // relative singular values that may vanish
constexpr double rank_is_lost = 1e-7, rank_is_kept = 1e-4;  // the same at a change point
constexpr double closes_all = 1e-10;                        // |F|∞ in units of curves that cross

/// Newton's method for ∂β/∂y = 0 from `at`; false where it does not end near by, or other than k
/// ranks are lost.
bool lose_ranks(PoseCurve& curve, Eigen::Index k, CurvePoint& at) {
  constexpr int most_steps = 25;
  constexpr double difference = 1e-5, settled = 1e-9;
  const CurvePoint start = at;
  VectorXd residual;
  MatrixXd J, ahead, behind;
  DenseLeastSquares least;
  double before = near_by;
  for (int pass = 0; pass < most_steps; ++pass) {
    curve.linearise(at, residual, J);
    const SingularValues svd(J);
    const VectorXd& values = svd.values;
    const Eigen::Index n = values.size(), kept = n - k;
    if (kept > 0 && !(values[kept - 1] > rank_is_kept * values[0])) return false;
    const MatrixXd psi = svd.u.rightCols(k), ways = svd.v.rightCols(k + 1);
    const auto turned = [&](const VectorXd& way) -> MatrixXd {  // ψᵀ ∂J/∂x(way) T
      VectorXd unused;
      curve.linearise(curve.moved(at, difference * way), unused, ahead);
      curve.linearise(curve.moved(at, -difference * way), unused, behind);
      return psi.transpose() * (ahead - behind) * ways / (2 * difference);
    };
    VectorXd step = VectorXd::Zero(n + 1);
    MatrixXd slope = psi.transpose() * J * ways;
    if (kept > 0) {
      step = -svd.solve(residual, kept);
      if (step.norm() > 0) slope += turned(step);
    }
    MatrixXd bends(k * (k + 1), k + 1);
    for (Eigen::Index i = 0; i <= k; ++i) bends.col(i) = turned(ways.col(i)).reshaped();
    least.compute(bends, rank_is_lost);
    step -= ways * least.solve(VectorXd(slope.reshaped()));
    const double size = step.norm();
    if (!(size < near_by)) return false;
    at = curve.moved(at, step);
    if (!(curve.way(start, at).norm() < near_by)) return false;
    if (size < settled && !(size < 0.1 * before))
      return values[n - k] < curve.lost(rank_is_lost) * values[0];
    before = size;
  }
  return false;
}

}  // namespace

bool change_point_near(PoseCurve& curve, const CurvePoint& near, CurvePoint& at) {
  VectorXd residual;
  MatrixXd J;
  curve.linearise(near, residual, J);
  const VectorXd values = SingularValues(J).values;
  for (Eigen::Index k = 1; k <= values.size() && values[values.size() - k] < seems_lost * values[0];
       ++k) {
    at = near;
    if (!lose_ranks(curve, k, at)) continue;
    return curve.linearise(at, residual, J) <= closes_all &&
           curve.reciprocal_condition(at.q) < curve.lost(rank_is_lost);
  }
  return false;
}

void go_straight_across(PoseCurve& curve, const CurvePoint& from, CurvePoint& at) {
  // First by the parabola through both points, tangent at `from`, then by differences.
  constexpr double distinct = 1e-4;
  const VectorXd chord = curve.way(from, at);
  at.tangent = chord.norm() > distinct ? 2 * chord.normalized() - from.tangent : from.tangent;
  at.tangent.normalize();
  at.orientation = 0;
  at.pivot = 0;
  CurvePoint ahead, behind;
  for (const double h : {1e-2, 1e-3})
    if (curve.step(at, h, ahead) && curve.step(at, -h, behind))
      at.tangent = curve.way(behind, ahead).normalized();
}

}  // namespace momenta
