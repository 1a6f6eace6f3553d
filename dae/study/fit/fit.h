#pragma once
// Dimensional synthesis: parameters of a scene for which a mechanism does what is wanted of it,
//
//   min ½ |r(x)|²,   x = (θ, s) (wanted_error.h),   from ≤ θ ≤ to,
//
// by the method of Levenberg and Marquardt with bounds (Ceres Solver) and the derivatives of
// pose_derivatives.h. Where no such mechanism can be assembled, or a wanted pose is not reached, a
// step is taken back and a shorter one tried: [[require]] of the scene holds on the way as well.
// Conditions, where they are named, are kept by constrained_search.h, where the method
// without them breaks them. The minimum is a local one. More starts, drawn between the bounds from
// a seed, make it likelier to be the least.
// Source: Levenberg 1944; Marquardt 1963; Agarwal, Mierle et al., Ceres Solver.

#include <momenta/dae/study/fit/search.h>
#include <momenta/dae/study/fit/swept_parts.h>
#include <momenta/dae/study/fit/user_constraints.h>
#include <momenta/dae/study/fit/wanted_error.h>

#include <string>
#include <vector>

namespace momenta {

/// Wanted poses to reach, and settings.
struct FitRequest : SearchRequest {
  std::string sweep;              ///< the swept coordinate, "O" or "J.q2"
  std::vector<std::string> keep;  ///< conditions, as MotionCondition takes them
  SweptWay way;                   ///< sweep for conditions, of the coordinate `sweep`
};

/// Result of one start. It has converged where conditions are kept, and cosine ≤ 1e-4, or the
/// Gauss-Newton step ≤ 1e-9 of the sizes, or r is rounding, or the slope of ½ |r|² ≤ 1e-6.
struct FitStart : SearchStart {
  double cost = none;  ///< ½ |r|² at its end
  /// Cosine of r with ∂r/∂x, as in LeastSquaresEnd: 0 at a minimum.
  double cosine = none;
  Eigen::VectorXd places;  ///< s_i at the end, if unknowns
};

/// Result of a fit.
struct FitResult : SearchResult<FitStart> {
  Column swept;                      ///< the swept coordinate
  WantedErrors before;               ///< errors of the given scene; NaN: a pose is not reached
  WantedErrors after;                ///< errors of the best
  WantedPoses wanted;                ///< as asked
  std::vector<double> places;        ///< s of each pose of the best [rad or m]
  Eigen::MatrixXd reached_before;    ///< y of the given scene, poses × quantities; or empty
  Eigen::MatrixXd reached;           ///< y of the best
  std::vector<UserConstraint> keep;  ///< conditions in order
  long evaluations = 0;              ///< evaluations of r, with or without ∂r/∂x
  long derivatives = 0;              ///< evaluations of ∂r/∂x
  /// One sentence on parameters that can change together without a change of r, to first order;
  /// empty: each matters by itself.
  std::string undetermined;
};

/// @throws SceneError where no start is possible, with the reason of the first;
/// std::invalid_argument for a bad request
/// Cost: an evaluation of r follows each wanted pose along its curve; one of ∂r/∂x takes six
/// mechanisms a parameter besides
FitResult fit(const ParametricMechanism& family, const WantedPoses& wanted,
              const FitRequest& request);

}  // namespace momenta
