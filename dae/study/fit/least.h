#pragma once
// Parameters of a scene for which a functional of its motion is least,
//
//   min J(θ),   conditions kept,   from ≤ θ ≤ to,
//
// of a motion that is swept (swept_parts.h) or of a run (motion_parts.h), by constrained_search.h.
// A mechanism that does not close, or does not reach a pose, is no candidate: the step is cut.
// Extremes are made smooth by bounded_function.h. The minimum is a local one; starts are drawn as
// by fit().

#include <momenta/dae/study/fit/constrained_search.h>
#include <momenta/dae/study/fit/fit.h>
#include <momenta/dae/study/fit/motion_parts.h>
#include <momenta/dae/study/fit/swept_parts.h>
#include <momenta/dae/study/fit/user_constraints.h>

#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// Functional to minimise, and settings.
struct LeastRequest : SearchRequest {
  std::string least;              ///< J, a formula (motion_formula.h)
  std::vector<std::string> keep;  ///< conditions, as MotionCondition takes them
  std::optional<SweptWay> way;    ///< sweep of the motion; none: a run
  SceneText scene;                ///< scene of a run
  RunSettings settings;           ///< settings of a run
};

/// Result of one start; without a motion at its end its violation is NaN.
struct LeastStart : SearchStart {
  LeastStart() { violation = none; }
  double value = none;  ///< J at the end
};

/// Result of a search.
struct LeastResult : SearchResult<LeastStart> {
  std::string least;                   ///< J, as asked
  bool run = false;                    ///< J is of a run; else of a sweep
  std::optional<Column> swept;         ///< the swept coordinate
  double before = WantedErrors::none;  ///< J of the given scene; NaN: none
  double after = WantedErrors::none;   ///< J of the best
  std::vector<UserConstraint> keep;    ///< conditions in order
  Eigen::VectorXd gradient;            ///< dJ/dθ of the best
  std::vector<double> places;          ///< s of the poses of a sweep [rad or m]
  /// A formula of single poses over the places, before and after.
  struct Curve {
    std::string formula;     ///< as written
    Eigen::VectorXd before;  ///< values by place; empty: none
    Eigen::VectorXd after;   ///< values by place
  };
  std::vector<Curve> curves;         ///< curves of J, then of conditions, each once
  long evaluations = 0;              ///< evaluations of J, with or without dJ/dθ
  long derivatives = 0;              ///< evaluations of dJ/dθ
  std::vector<std::string> remarks;  ///< sentences on jumps and kinks of runs
};

/// @throws SceneError where no start is possible, with the reason of the first;
/// std::invalid_argument for a bad request
LeastResult least(const ParametricMechanism& family, const LeastRequest& request);

}  // namespace momenta
