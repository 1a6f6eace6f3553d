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

#include <momenta/dae/fit/fitted_parameter.h>
#include <momenta/dae/fit/kept_conditions.h>
#include <momenta/dae/fit/swept_parts.h>
#include <momenta/dae/fit/wanted_error.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace momenta {

class Journal;  // dae/study/journal.h

/// Parameters to vary, and settings.
struct FitRequest {
  std::vector<FittedParameter> parameters;  ///< at least one
  std::string sweep;                        ///< the swept coordinate, "O" or "J.q2"
  int starts = 1;                           ///< the first is the scene's own
  std::uint64_t seed = 1;                   ///< for further starts, which need ranges
  int most_iterations = 500;                ///< per start
  std::vector<std::string> keep;            ///< conditions, as MotionCondition takes them
  SweptWay way;                             ///< sweep for conditions, of the coordinate `sweep`
  /// Journal of finished starts; null: none.
  Journal* journal = nullptr;
  /// Called before each start (number, least error so far); false ends the search.
  std::function<bool(int, double)> progress;
};

/// Result of one start.
struct FitStart {
  Eigen::VectorXd from;              ///< θ where it began
  Eigen::VectorXd to;                ///< θ where it ended; empty: impossible start
  double cost = WantedErrors::none;  ///< ½ |r|² at its end
  int iterations = 0;                ///< iterations of the search
  /// Cosine of r with ∂r/∂x, as in LeastSquaresEnd: 0 at a minimum.
  double cosine = WantedErrors::none;
  Eigen::VectorXd places;  ///< s_i at the end, if unknowns
  /// Slope of ½ |r|², as in ConstrainedEnd; NaN: not held by conditions.
  double slope = WantedErrors::none;
  double violation = 0;             ///< largest of a condition; 0: all kept
  std::vector<double> multipliers;  ///< by condition, as in KeptCondition
  /// Conditions are kept, and cosine ≤ 1e-4, or the Gauss-Newton step ≤ 1e-9 of the sizes, or r is
  /// rounding, or slope ≤ 1e-6.
  bool converged = false;
  std::string why;  ///< why not converged, a sentence without full stop
};

/// Result of a fit.
struct FitResult {
  std::string scene;                        ///< name
  std::vector<FittedParameter> parameters;  ///< θ, as asked
  Column swept;                             ///< the swept coordinate
  std::uint64_t seed = 1;                   ///< as asked
  Eigen::VectorXd own;                      ///< θ of the scene
  Eigen::VectorXd found;                    ///< the best θ
  WantedErrors before;              ///< errors of the given scene; NaN: a pose is not reached
  WantedErrors after;               ///< errors of the best
  std::string why_not_before;       ///< why `before` is NaN; else empty
  WantedPoses wanted;               ///< as asked
  std::vector<double> places;       ///< s of each pose of the best [rad or m]
  Eigen::MatrixXd reached_before;   ///< y of the given scene, poses × quantities; or empty
  Eigen::MatrixXd reached;          ///< y of the best
  std::vector<KeptCondition> keep;  ///< conditions in order
  std::vector<FitStart> starts;     ///< starts in order
  std::size_t best = 0;             ///< index of the best start
  long evaluations = 0;             ///< evaluations of r, with or without ∂r/∂x
  long derivatives = 0;             ///< evaluations of ∂r/∂x
  bool stopped = false;             ///< stopped by `progress`
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
