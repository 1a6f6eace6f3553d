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

#include <momenta/dae/study/fit/fit.h>
#include <momenta/dae/study/fit/measured_error.h>

namespace momenta {

/// Runs to compare with what was measured, and settings.
struct IdentificationRequest : SearchRequest {
  SceneText scene;       ///< text of the family's scene
  RunSettings settings;  ///< runs end at the last measured time
};

/// Result of an identification.
struct Identification : SearchResult<FitStart> {
  RunSettings settings;  ///< settings of the runs
  /// Standard deviations of `found`, in units of θ: NaN where a bound holds θ, r leaves it open, or
  /// N ≤ n.
  Eigen::VectorXd deviations;
  MeasuredMotion measured;                  ///< as asked
  Eigen::MatrixXd before;                   ///< y of the given scene, times × quantities; or empty
  Eigen::MatrixXd after;                    ///< y of the best
  double cost_before = WantedErrors::none;  ///< ½ |r|² of the given scene; NaN: no run
  double cost_after = WantedErrors::none;   ///< ½ |r|² of the best
  long runs = 0;                            ///< runs with derivatives
  std::string undetermined;                 ///< as in FitResult
  std::vector<std::string> remarks;         ///< sentences on jumps and kinks of runs

  /// Root mean square and maximum of |value − measured|, by quantity: 2 columns.
  Eigen::MatrixXd errors(const Eigen::MatrixXd& values) const;
};

/// @throws SceneError where no start is possible, with the reason of the first;
/// std::invalid_argument for a bad request
/// Cost: a forward gradient of a run by all θ for each step tried
Identification identify(const ParametricMechanism& family, const MeasuredMotion& measured,
                        const IdentificationRequest& request);

}  // namespace momenta
