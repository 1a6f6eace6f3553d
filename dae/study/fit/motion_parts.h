#pragma once
// Numbers of a motion as functions of parameters θ of the scene, with their derivatives: what
// formulas of a motion are made of. A motion is swept (swept_parts.h) or run.

#include <momenta/dae/gradient/gradient.h>
#include <momenta/dae/study/fit/motion_formula.h>
#include <momenta/dae/study/fit/parametric_mechanism.h>
#include <momenta/dae/study/fit/trial_limit.h>

#include <string>
#include <vector>

namespace momenta {

/// A motion at θ, with derivatives if asked for.
struct MotionValues {
  Eigen::VectorXd parameters;     ///< all of the scene, formulas of θ among them
  Eigen::MatrixXd parameters_by;  ///< parameters × θ
  /// By part: g at each pose for an extreme of a swept motion, else one number.
  std::vector<Eigen::VectorXd> parts;
  std::vector<Eigen::MatrixXd> parts_by;  ///< by part, rows × θ
};

/// Numbers of a motion, by θ.
class MotionParts {
 public:
  /// `sizes` of θ, > 0, scale steps of differences. The family must outlive it.
  MotionParts(const ParametricMechanism& family, Eigen::VectorXd sizes);
  virtual ~MotionParts() = default;

  /// Adds a part; its place. @throws std::invalid_argument: one sentence
  virtual std::size_t add(const MotionPart& part) = 0;
  /// The motion at θ; false without it or its derivatives: why() says why.
  virtual bool at(const Eigen::VectorXd& theta, bool derivatives, MotionValues& values) = 0;
  const std::string& why() const { return why_; }  ///< a sentence without full stop

  /// Names of the scene's parameters, as in MotionValues.
  const std::vector<std::string>& parameter_names() const { return parameter_names_; }

 protected:
  /// All parameters of the scene at θ. @throws SceneError
  Eigen::VectorXd parameters_at(const Eigen::VectorXd& theta) const;
  /// The same with derivatives by θ, differences for formulas. @throws SceneError
  void take_parameters(const Eigen::VectorXd& theta, bool derivatives, MotionValues& values) const;

  const ParametricMechanism& family_;  ///< θ ↦ mechanism
  Eigen::VectorXd sizes_;              ///< sizes of θ
  std::string why_;                    ///< as why()

 private:
  std::vector<std::string> parameter_names_;
};

/// A formula of a motion, ready to be evaluated.
class MotionFunction {
 public:
  /// Adds its parts to `parts`. @throws std::invalid_argument: one sentence
  MotionFunction(const MotionFormula& formula, MotionParts& parts);

  /// Places of its parts in MotionValues.
  const std::vector<std::size_t>& places() const { return places_; }
  /// Parts in the order of places().
  const std::vector<MotionPart>& parts() const { return parts_; }
  /// Poses of the extremes; 0 for other parts.
  std::vector<Eigen::Index> rows(const MotionValues& values) const;
  /// Value with the parts at `rows`, or `taken` where not NaN; derivatives by θ and by the parts
  /// unless null.
  double at(const MotionValues& values, const std::vector<Eigen::Index>& rows,
            const Eigen::VectorXd& taken, Eigen::VectorXd* by_theta,
            Eigen::VectorXd* by_parts) const;
  /// Value with the extremes of the motion.
  double value(const MotionValues& values) const;
  /// Parts of which a larger maximum, or a smaller minimum, makes the value larger: they can be
  /// bounded from outside while it is minimised.
  std::vector<std::size_t> bounded(const MotionValues& values) const;

 private:
  std::vector<MotionPart> parts_;
  std::vector<std::size_t> places_;
  std::unique_ptr<SmoothFormula> outer_;
};

// Parts of a run: last(g), integral(g) = ∫ g dt and mean(g), with the exact derivatives of the
// run's own steps (dae/gradient/gradient.h). A run takes its largest and smallest values at times
// that these derivatives do not tell: max and min are refused.

/// Numbers of a run, by θ.
class RunParts final : public MotionParts {
 public:
  /// `scene`: text of the family's scene. A fixed step in `settings` makes the function smooth.
  RunParts(const ParametricMechanism& family, Eigen::VectorXd sizes, SceneText scene,
           RunSettings settings);
  std::size_t add(const MotionPart& part) override;
  /// Cost: that of gradient(), for each part
  bool at(const Eigen::VectorXd& theta, bool derivatives, MotionValues& values) override;

  /// Remarks of the gradients, each once.
  const std::vector<std::string>& remarks() const { return remarks_; }
  TrialLimit& limit() { return limit_; }  ///< of runs to come

 private:
  TrialLimit limit_;
  SceneText scene_;
  RunSettings settings_;
  std::vector<MotionPart> parts_;
  std::vector<std::string> remarks_;
};

}  // namespace momenta
