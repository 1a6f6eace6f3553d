#pragma once
// What the searches for parameters ask and find alike: fit() for wanted poses, identify() for a
// measured motion, least() for a functional of a motion.

#include <momenta/dae/study/fit/fitted_parameter.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace momenta {

class Journal;  // dae/study/journal.h

/// Parameters to vary, and settings.
struct SearchRequest {
  std::vector<FittedParameter> parameters;  ///< at least one
  int starts = 1;                           ///< the first is the scene's own
  std::uint64_t seed = 1;                   ///< for further starts, which need ranges
  int most_iterations = 500;                ///< per start
  /// Journal of finished starts; null: none.
  Journal* journal = nullptr;
  /// Called with the number of the start and the least so far before each start (fit), run
  /// (identify) or step (least); false ends the search, the start under way as it is.
  std::function<bool(int, double)> progress;
};

/// Result of one start.
struct SearchStart {
  /// Not measured.
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd from;             ///< θ where it began
  Eigen::VectorXd to;               ///< θ where it ended; empty: impossible start
  int iterations = 0;               ///< iterations of the search
  double slope = none;              ///< as in ConstrainedEnd, 0 at a minimum; NaN: not measured
  double violation = 0;             ///< largest of a condition; 0: all kept
  std::vector<double> multipliers;  ///< by condition, as in UserConstraint
  bool converged = false;           ///< a minimum that keeps the conditions
  std::string why;                  ///< why not converged, a sentence without full stop
};

/// Result of a search.
template <class Start>
struct SearchResult {
  std::string scene;                        ///< name
  std::vector<FittedParameter> parameters;  ///< θ, as asked
  std::uint64_t seed = 1;                   ///< as asked
  Eigen::VectorXd own;                      ///< θ of the scene
  Eigen::VectorXd found;                    ///< the best θ
  std::string why_not_before;               ///< why the given scene has no value; else empty
  std::vector<Start> starts;                ///< starts in order
  std::size_t best = 0;                     ///< index of the best start
  bool stopped = false;                     ///< stopped by `progress`
};

}  // namespace momenta
