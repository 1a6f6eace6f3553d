#pragma once
// Parameters of a scene for which a functional of its motion is least,
//
//   min J(θ),   conditions kept,   from ≤ θ ≤ to,
//
// of a motion that is swept (swept_parts.h) or of a run (motion_parts.h), by constrained_search.h.
// A mechanism that does not close, or does not reach a pose, is no candidate: the step is cut.
// Extremes are made smooth by bounded_function.h. The minimum is a local one; starts are drawn as
// by fit().

#include <momenta/dae/fit/constrained_search.h>
#include <momenta/dae/fit/fit.h>
#include <momenta/dae/fit/kept_conditions.h>
#include <momenta/dae/fit/motion_parts.h>
#include <momenta/dae/fit/swept_parts.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// Functional to minimise, and settings.
struct LeastRequest {
  std::vector<FittedParameter> parameters;  ///< at least one
  std::string least;                        ///< J, a formula (motion_formula.h)
  std::vector<std::string> keep;            ///< conditions, as MotionCondition takes them
  std::optional<SweptWay> way;              ///< sweep of the motion; none: a run
  SceneText scene;                          ///< scene of a run
  RunSettings settings;                     ///< settings of a run
  int starts = 1;                           ///< the first is the scene's own
  std::uint64_t seed = 1;                   ///< for further starts, which need ranges
  int most_iterations = 500;                ///< per start
  /// Journal of finished starts; null: none.
  Journal* journal = nullptr;
  /// Called before each step (start, least J so far); false ends the search with the start as it
  /// is.
  std::function<bool(int, double)> progress;
};

/// Result of one start.
struct LeastStart {
  Eigen::VectorXd from;                   ///< θ where it began
  Eigen::VectorXd to;                     ///< θ where it ended; empty: impossible start
  double value = WantedErrors::none;      ///< J at the end
  double violation = WantedErrors::none;  ///< largest of a condition; 0: all kept
  double slope = WantedErrors::none;      ///< as in ConstrainedEnd: 0 at a minimum
  std::vector<double> multipliers;        ///< by condition, as in KeptCondition
  int iterations = 0;                     ///< iterations of the search
  bool converged = false;                 ///< a minimum that keeps the conditions
  std::string why;                        ///< why not converged, a sentence without full stop
};

/// Result of a search.
struct LeastResult {
  std::string scene;                        ///< name
  std::vector<FittedParameter> parameters;  ///< θ, as asked
  std::string least;                        ///< J, as asked
  bool run = false;                         ///< J is of a run; else of a sweep
  std::optional<Column> swept;              ///< the swept coordinate
  std::uint64_t seed = 1;                   ///< as asked
  Eigen::VectorXd own;                      ///< θ of the scene
  Eigen::VectorXd found;                    ///< the best θ
  double before = WantedErrors::none;       ///< J of the given scene; NaN: none
  double after = WantedErrors::none;        ///< J of the best
  std::string why_not_before;               ///< why `before` is NaN; else empty
  std::vector<KeptCondition> keep;          ///< conditions in order
  Eigen::VectorXd gradient;                 ///< dJ/dθ of the best
  std::vector<double> places;               ///< s of the poses of a sweep [rad or m]
  /// A formula of single poses over the places, before and after.
  struct Curve {
    std::string formula;     ///< as written
    Eigen::VectorXd before;  ///< values by place; empty: none
    Eigen::VectorXd after;   ///< values by place
  };
  std::vector<Curve> curves;         ///< curves of J, then of conditions, each once
  std::vector<LeastStart> starts;    ///< starts in order
  std::size_t best = 0;              ///< index of the best start
  long evaluations = 0;              ///< evaluations of J, with or without dJ/dθ
  long derivatives = 0;              ///< evaluations of dJ/dθ
  bool stopped = false;              ///< stopped by `progress`
  std::vector<std::string> remarks;  ///< sentences on jumps and kinks of runs
};

/// @throws SceneError where no start is possible, with the reason of the first;
/// std::invalid_argument for a bad request
LeastResult least(const ParametricMechanism& family, const LeastRequest& request);

}  // namespace momenta
