#pragma once
// Dimensional synthesis: parameters of a scene for which a mechanism does what is wanted of it,
//
//   min ½ |r(x)|²,   x = (θ, s) (wanted_error.h),   from ≤ θ ≤ to,
//
// by the method of Levenberg and Marquardt with bounds (Ceres Solver) and the derivatives of
// pose_derivatives.h. Where no such mechanism can be assembled, or a wanted pose is not reached, a
// step is taken back and a shorter one tried: [[require]] of the scene holds on the way as well.
// Conditions, where they are named, are kept by constrained_search.h, where the method
// without them breaks them. A minimum so found is a local one. More starts, drawn with a seed
// from between the bounds, make it likelier to be the least; they follow from the seed alone.
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

/// What is varied, and how.
struct FitRequest {
  std::vector<FittedParameter> parameters;  ///< at least one
  std::string sweep;                        ///< the swept coordinate, "O" or "J.q2"
  int starts = 1;                           ///< the first is the scene's own
  std::uint64_t seed = 1;                   ///< of the others; they need ranges
  int most_iterations = 500;                ///< of each start
  std::vector<std::string> keep;            ///< conditions, as MotionCondition takes them
  SweptWay way;  ///< of conditions of a motion; `sweep` is its coordinate
  /// Starts that are finished, and where they are kept; null: nowhere.
  Journal* journal = nullptr;
  /// Called before each start, with its number and the least error so far; false ends the search.
  std::function<bool(int, double)> progress;
};

/// What came of one start.
struct FitStart {
  Eigen::VectorXd from;              ///< θ where it began
  Eigen::VectorXd to;                ///< θ where it ended; empty where the start is not possible
  double cost = WantedErrors::none;  ///< ½ |r|² at its end
  int iterations = 0;                ///< of the method
  /// Of r with ∂r/∂x, as of LeastSquaresEnd: 0 at a minimum.
  double cosine = WantedErrors::none;
  Eigen::VectorXd places;  ///< s_i at its end, where they are unknowns
  /// Of ½ |r|² where conditions hold the search, as of ConstrainedEnd; else NaN.
  double slope = WantedErrors::none;
  double violation = 0;             ///< of conditions, the largest; 0: all are kept
  std::vector<double> multipliers;  ///< of conditions, as of KeptCondition
  /// Conditions are kept, and cosine ≤ 1e-4, or Gauss and Newton's step is below 1e-9 of the
  /// parameters' sizes, or r is rounding, or slope ≤ 1e-6.
  bool converged = false;
  std::string why;  ///< why not, one sentence without its full stop; else empty
};

/// What a fit found.
struct FitResult {
  std::string scene;                        ///< its name
  std::vector<FittedParameter> parameters;  ///< θ, as asked
  Column swept;                             ///< the swept coordinate
  std::uint64_t seed = 1;                   ///< as asked
  Eigen::VectorXd own;                      ///< θ of the scene
  Eigen::VectorXd found;                    ///< the best θ
  WantedErrors before;              ///< of the scene as it is: NaN where a pose is not reached
  WantedErrors after;               ///< of the best
  std::string why_not_before;       ///< which; else empty
  WantedPoses wanted;               ///< as asked
  std::vector<double> places;       ///< s of each pose [rad or m], of the best
  Eigen::MatrixXd reached_before;   ///< poses × quantities; empty where one is not reached
  Eigen::MatrixXd reached;          ///< of the best
  std::vector<KeptCondition> keep;  ///< in their order
  std::vector<FitStart> starts;     ///< in their order
  std::size_t best = 0;             ///< place among them
  long evaluations = 0;             ///< of r, those with derivatives included
  long derivatives = 0;             ///< of ∂r/∂x
  bool stopped = false;             ///< by `progress`
  /// Groups of parameters that can change together so that what is wanted does not, to first order:
  /// one sentence; empty: each of them matters by itself.
  std::string undetermined;
};

/// @throws SceneError where no start is possible: the sentence says why the first is not;
/// std::invalid_argument for what is asked
/// Cost: an evaluation of r follows each wanted pose along its curve; one of ∂r/∂x takes six
/// mechanisms a parameter besides (pose_derivatives.h)
FitResult fit(const ParametricMechanism& family, const WantedPoses& wanted,
              const FitRequest& request);

}  // namespace momenta
