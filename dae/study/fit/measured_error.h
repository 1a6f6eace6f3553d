#pragma once
// How far the run of a mechanism is from what was measured, as residuals of a least-squares
// problem,
//
//   r_ik = (y_k(t_i; θ) − y*_ik) / w_k,      ∂r_ik/∂θ = (∂y_k/∂θ)(t_i) / w_k
//
// for each time i and quantity k that was measured. w_k is the largest range of a measured quantity
// of the same unit, so that units do not matter. y is that of the run, on the dense output between
// its steps, and ∂y/∂θ its exact derivative with the steps held, start included
// (dae/gradient/gradient.h).

#include <momenta/dae/gradient/gradient.h>
#include <momenta/dae/study/fit/measured_motion.h>
#include <momenta/dae/study/fit/parametric_mechanism.h>
#include <momenta/dae/study/fit/trial_limit.h>

#include <string>
#include <vector>

namespace momenta {

/// Residuals of a measured motion, by θ.
class MeasuredError {
 public:
  /// `scene`: text of the family's scene. All references must outlive it.
  MeasuredError(const ParametricMechanism& family, const SceneText& scene, RunSettings settings,
                const MeasuredMotion& measured);

  /// r (count) and ∂r/∂θ (count × parameters), unless null. False without a run or a derivative:
  /// why() says which. Cost: a forward gradient by all θ, once for the same θ
  bool evaluate(const Eigen::VectorXd& theta, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian);
  /// y (times × quantities, in their units) of the last success.
  const Eigen::MatrixXd& reached() const { return reached_; }
  const RunSettings& settings() const { return settings_; }  ///< as run
  const std::string& why() const { return why_; }            ///< a sentence without full stop
  /// Remarks of the gradients, each once.
  const std::vector<std::string>& remarks() const { return remarks_; }
  long runs() const { return runs_; }     ///< runs so far
  TrialLimit& limit() { return limit_; }  ///< of runs to come

  /// w_k of each quantity.
  const Eigen::VectorXd& weights() const { return weights_; }

 private:
  const ParametricMechanism& family_;
  const SceneText& scene_;
  RunSettings settings_;
  const MeasuredMotion& measured_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd theta_, r_;  ///< at the last evaluation
  Eigen::MatrixXd jacobian_, reached_;
  std::vector<std::string> remarks_;
  std::string why_;
  long runs_ = 0;
  TrialLimit limit_;
};

}  // namespace momenta
