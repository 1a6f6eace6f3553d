#pragma once
// Numbers of a motion as functions of parameters θ of the scene, with their derivatives: what
// formulas of a motion are made of. A motion is swept (swept_parts.h) or run (run_parts.h).

#include <momenta/dae/fit/motion_formula.h>
#include <momenta/dae/fit/parametric_mechanism.h>

#include <string>
#include <vector>

namespace momenta {

/// A motion at θ. Derivatives are there where they were asked for.
struct MotionValues {
  Eigen::VectorXd parameters;     ///< all of the scene, formulas of θ among them
  Eigen::MatrixXd parameters_by;  ///< by θ
  /// Of each part: of an extreme of a swept motion g at each pose, else one number.
  std::vector<Eigen::VectorXd> parts;
  std::vector<Eigen::MatrixXd> parts_by;  ///< of each, rows × θ
};

/// Numbers of a motion, by θ.
class MotionParts {
 public:
  /// `sizes` of θ, > 0: of what steps of differences are a part. The family must outlive it.
  MotionParts(const ParametricMechanism& family, Eigen::VectorXd sizes);
  virtual ~MotionParts() = default;

  /// A further part; its place. @throws std::invalid_argument: one sentence
  virtual std::size_t add(const MotionPart& part) = 0;
  /// The motion at θ; false where there is none, or it has no derivatives: why() says why.
  virtual bool at(const Eigen::VectorXd& theta, bool derivatives, MotionValues& values) = 0;
  const std::string& why() const { return why_; }  ///< one sentence, without its full stop

  /// Names of all parameters of the scene, in the order of MotionValues.
  const std::vector<std::string>& parameter_names() const { return parameter_names_; }

 protected:
  /// All parameters of the scene at θ. @throws SceneError
  Eigen::VectorXd parameters_at(const Eigen::VectorXd& theta) const;
  /// The same with derivatives by θ, differences for those that are formulas. @throws SceneError
  void take_parameters(const Eigen::VectorXd& theta, bool derivatives, MotionValues& values) const;

  const ParametricMechanism& family_;  ///< θ ↦ mechanism
  Eigen::VectorXd sizes_;              ///< of θ
  std::string why_;                    ///< as why()

 private:
  std::vector<std::string> parameter_names_;
};

/// A formula of a motion, ready to be evaluated.
class MotionFunction {
 public:
  /// Its parts are added to `parts`. @throws std::invalid_argument: one sentence
  MotionFunction(const MotionFormula& formula, MotionParts& parts);

  /// Where its parts stand in MotionValues, and of what kind they are.
  const std::vector<std::size_t>& places() const { return places_; }
  /// In their order.
  const std::vector<MotionPart>& parts() const { return parts_; }
  /// The poses at which extremes are taken; 0 of other parts.
  std::vector<Eigen::Index> rows(const MotionValues& values) const;
  /// Its value with its parts at these rows, `taken` in their place where they are not NaN; its
  /// derivative by θ, and by its parts, where these are not null.
  double at(const MotionValues& values, const std::vector<Eigen::Index>& rows,
            const Eigen::VectorXd& taken, Eigen::VectorXd* by_theta,
            Eigen::VectorXd* by_parts) const;
  /// Its value as it is.
  double value(const MotionValues& values) const;
  /// Its extremes of which more of a maximum, or less of a minimum, would make it larger: those
  /// that can be bounded from outside while it is made less.
  std::vector<std::size_t> bounded(const MotionValues& values) const;

 private:
  std::vector<MotionPart> parts_;
  std::vector<std::size_t> places_;
  std::unique_ptr<SmoothFormula> outer_;
};

}  // namespace momenta
