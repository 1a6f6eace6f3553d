#pragma once
// Identification: parameters of a scene for which its run comes nearest to a measured motion,
//
//   min ½ |r(θ)|²   (measured_error.h),   from ≤ θ ≤ to,
//
// masses, springs, dampers, lengths, start values, by the method of Levenberg and Marquardt with
// bounds (least_squares_search.h); starts as of fit(). Where the mechanism cannot be assembled, or
// its run fails, a step is taken back and a shorter one tried. With N numbers measured, of errors
// that are independent and of one size in units of w_k, and n parameters of which no bound holds
// one, the covariance of θ is, to first order,
//
//   s² (JᵀJ)⁻¹,      s² = |r|²/(N − n),      J = ∂r/∂θ
//
// Source: Bard, Nonlinear Parameter Estimation, 1974, ch. 7; Ljung, System Identification, 1999,
// ch. 10.

#include <momenta/dae/fit/fit.h>
#include <momenta/dae/fit/measured_error.h>

namespace momenta {

/// What is varied, and how.
struct IdentificationRequest {
  std::vector<FittedParameter> parameters;  ///< at least one
  SceneText scene;                          ///< that of the family, as text
  RunSettings settings;                     ///< of the runs, which end at the last measured time
  int starts = 1;                           ///< the first is the scene's own
  std::uint64_t seed = 1;                   ///< of the others; they need ranges
  int most_iterations = 500;                ///< of each start
  /// Starts that are finished, and where they are kept; null: nowhere.
  Journal* journal = nullptr;
  /// Called before each run, with the number of the start and the least cost so far; false ends the
  /// search, and what the start has come to is left.
  std::function<bool(int, double)> progress;
};

/// What was found.
struct Identification {
  std::string scene;                        ///< its name
  std::vector<FittedParameter> parameters;  ///< θ, as asked
  std::uint64_t seed = 1;                   ///< as asked
  RunSettings settings;                     ///< of the runs
  Eigen::VectorXd own;                      ///< θ of the scene
  Eigen::VectorXd found;                    ///< the best θ
  /// Of `found`, standard deviations in the units of θ: NaN where a bound holds it, r leaves it
  /// open, or no more is measured than found.
  Eigen::VectorXd deviations;
  MeasuredMotion measured;  ///< as asked
  Eigen::MatrixXd before;   ///< times × quantities, of the scene as it is; empty: no such run
  Eigen::MatrixXd after;    ///< of the best
  double cost_before = WantedErrors::none;  ///< ½ |r|²; NaN: no such run
  double cost_after = WantedErrors::none;   ///< of the best
  std::string why_not_before;               ///< why no such run; else empty
  std::vector<FitStart> starts;             ///< in their order
  std::size_t best = 0;                     ///< place among them
  long runs = 0;                            ///< with their derivatives
  bool stopped = false;                     ///< by `progress`
  std::string undetermined;                 ///< as of FitResult
  std::vector<std::string> remarks;         ///< sentences on what of a run is not smooth

  /// Root mean square and largest size of value − measured, of each quantity in its unit: 2
  /// columns.
  Eigen::MatrixXd errors(const Eigen::MatrixXd& values) const;
};

/// @throws SceneError where no start is possible: the sentence says why the first is not;
/// std::invalid_argument for what is asked
/// Cost: a forward gradient of a run by all θ for each step tried
Identification identify(const ParametricMechanism& family, const MeasuredMotion& measured,
                        const IdentificationRequest& request);

}  // namespace momenta
