#pragma once
// Parameters of a scene for which a functional of its motion is least,
//
//   min J(θ),   conditions kept,   from ≤ θ ≤ to,
//
// of a motion that is swept (swept_parts.h) or of a run (run_parts.h), by constrained_search.h. A
// mechanism that does not close, or does not reach a pose, is no candidate: the step is cut.
// Extremes are made smooth by bounded_function.h. A minimum so found is a local one; starts are
// drawn as by fit(), and follow from the seed.

#include <momenta/dae/fit/constrained_search.h>
#include <momenta/dae/fit/fit.h>
#include <momenta/dae/fit/kept_conditions.h>
#include <momenta/dae/fit/run_parts.h>
#include <momenta/dae/fit/swept_parts.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// What is to be least, and how.
struct LeastRequest {
  std::vector<FittedParameter> parameters;  ///< at least one
  std::string least;                        ///< J, a formula (motion_formula.h)
  std::vector<std::string> keep;            ///< conditions, as MotionCondition takes them
  std::optional<SweptWay> way;              ///< of a swept motion; none: of a run
  SceneText scene;                          ///< of a run
  RunSettings settings;                     ///< of a run
  int starts = 1;                           ///< the first is the scene's own
  std::uint64_t seed = 1;                   ///< of the others; they need ranges
  int most_iterations = 500;                ///< of each start
  /// Starts that are finished, and where they are kept; null: nowhere.
  Journal* journal = nullptr;
  /// Called before each step, with the number of the start and the least J so far; false ends the
  /// search, and what the start has come to is left.
  std::function<bool(int, double)> progress;
};

/// What came of one start.
struct LeastStart {
  Eigen::VectorXd from;                   ///< θ where it began
  Eigen::VectorXd to;                     ///< θ at its end; empty where the start is not possible
  double value = WantedErrors::none;      ///< J at its end
  double violation = WantedErrors::none;  ///< of conditions, the largest; 0: all are kept
  double slope = WantedErrors::none;      ///< as of ConstrainedEnd: 0 at a minimum
  std::vector<double> multipliers;        ///< of conditions, as of KeptCondition
  int iterations = 0;                     ///< of the method
  bool converged = false;                 ///< a minimum that keeps the conditions
  std::string why;  ///< why not, one sentence without its full stop; else empty
};

/// What was found.
struct LeastResult {
  std::string scene;                        ///< its name
  std::vector<FittedParameter> parameters;  ///< θ, as asked
  std::string least;                        ///< J, as asked
  bool run = false;                         ///< of a run; else of a swept motion
  std::optional<Column> swept;              ///< the swept coordinate
  std::uint64_t seed = 1;                   ///< as asked
  Eigen::VectorXd own;                      ///< θ of the scene
  Eigen::VectorXd found;                    ///< the best θ
  double before = WantedErrors::none;       ///< J of the scene as it is; NaN: it has none
  double after = WantedErrors::none;        ///< of the best
  std::string why_not_before;               ///< why none; else empty
  std::vector<KeptCondition> keep;          ///< in their order
  Eigen::VectorXd gradient;                 ///< dJ/dθ of the best
  std::vector<double> places;               ///< of a swept motion, s of its poses [rad or m]
  /// What the formulas are made of, over the places: before, where there is such, and after.
  struct Curve {
    std::string formula;     ///< of single poses
    Eigen::VectorXd before;  ///< at each place; empty: there is none
    Eigen::VectorXd after;   ///< at each place
  };
  std::vector<Curve> curves;         ///< of J, then of the conditions, each once
  std::vector<LeastStart> starts;    ///< in their order
  std::size_t best = 0;              ///< place among them
  long evaluations = 0;              ///< of J, those with derivatives included
  long derivatives = 0;              ///< of dJ/dθ
  bool stopped = false;              ///< by `progress`
  std::vector<std::string> remarks;  ///< sentences on what of a run is not smooth
};

/// @throws SceneError where no start is possible: the sentence says why the first is not;
/// std::invalid_argument for what is asked
LeastResult least(const ParametricMechanism& family, const LeastRequest& request);

}  // namespace momenta
