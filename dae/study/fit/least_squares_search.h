#pragma once
// min ½ |r(x)|² between bounds, by the method of Levenberg and Marquardt. Ceres Solver, which does
// it, is seen by least_squares_search.cpp alone. Its steps are made without bounds and cut at them,
// and come to a halt where one is met; so the search goes on without the unknowns that a bound
// holds, those with x_j at it and the gradient Jᵀr pointing beyond, until the rest is at its
// minimum and no held one would go back.
// Source: Levenberg 1944; Marquardt 1963; active sets: Nocedal, Wright, Numerical Optimization,
// ch. 10, 16.

#include <Eigen/Core>
#include <functional>
#include <limits>

namespace momenta {

/// r at x, and ∂r/∂x unless null; false: r does not exist here, and a shorter step is tried.
using Residuals =
    std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian)>;

struct LeastSquaresEnd {
  bool began = false;  ///< r and ∂r/∂x could be evaluated where the search began
  int iterations = 0;
  Eigen::VectorXd r;  ///< at the best point
  /// Largest cosine of the angle between r and a column of ∂r/∂x, of unknowns that no bound holds:
  /// 0 at a minimum.
  double cosine = std::numeric_limits<double>::quiet_NaN();
  /// Largest part of its size by which the Gauss-Newton step would move such an unknown: where r is
  /// rounding so is this, while the cosine is any number.
  double step = std::numeric_limits<double>::quiet_NaN();
};

/// Limits; above both no minimum is claimed.
inline constexpr double converged_cosine = 1e-4, converged_step = 1e-9;

/// Searches from x, `sizes` > 0, between `least` and `most`, which may be infinite; leaves the best
/// point in x.
LeastSquaresEnd least_squares_search(const Residuals& residuals, const Eigen::VectorXd& least,
                                     const Eigen::VectorXd& most, const Eigen::VectorXd& sizes,
                                     int most_iterations, Eigen::VectorXd& x);

}  // namespace momenta
