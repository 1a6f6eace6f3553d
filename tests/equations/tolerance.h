#pragma once
// The two tolerances of the tests. algebra_tol(n) is what arithmetic promises: a multiple of
// rounding that grows with the size of the problem. promise_tol(h, order) is what an integrator
// promises.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta::equations {

/// 16 roundings for each of n bodies; 1.4e-14 for a tree of four, 4.3e-14 for twelve.
inline double algebra_tol(int n) {
  return 16 * std::numeric_limits<double>::epsilon() * std::max(n, 1);
}

/// Error of an integrator of this order with step h, up to a constant of the problem.
inline double promise_tol(double h, int order, double constant = 1) {
  return constant * std::pow(h, order);
}

/// max |a − b| relative to max |b|, and to `floor` where b is small or empty.
template <class A, class B>
double relative_error(const A& a, const B& b, double floor = 1) {
  if (b.size() == 0) return a.size() == 0 ? 0 : std::numeric_limits<double>::infinity();
  // NaN must not pass for small
  if (!(a - b).allFinite()) return std::numeric_limits<double>::infinity();
  const double error = (a - b).cwiseAbs().maxCoeff();
  return error / std::max(floor, static_cast<double>(b.cwiseAbs().maxCoeff()));
}

/// The larger of two errors. NaN stays, which std::max may drop.
inline double larger(double a, double b) {
  return std::isnan(a) || b <= a ? a : b;
}

/// An error over what rounding grows to on its way, where that leaves digits to judge by. A growth
/// beyond `most`, or none that is a number, would let a wrong formula pass: ∞ then, so that the
/// test fails that counts on such a state.
inline double over_growth(double error, double growth, double most = 1e4) {
  const bool judged = std::isfinite(error) && growth >= 1 && growth <= most;
  return judged ? error / growth : std::numeric_limits<double>::infinity();
}

}  // namespace momenta::equations
