#pragma once
// A mechanism as a function of numbers of its scene, θ ↦ mechanism: the scene is read anew with
// these numbers in the place of its own, formulas of [parameters] included.

#include <momenta/core/format/toml/setting.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// A mechanism by parameters of its scene.
class ParametricMechanism {
 public:
  /// `text`: a scene in TOML, which messages call `file`; `fixed`: numbers that are the same for
  /// all θ; `names`: of [parameters], or places (setting.h), in the order of θ. @throws
  /// std::invalid_argument for names that the scene does not have, one sentence
  ParametricMechanism(std::string text, std::string file, std::vector<Setting> fixed,
                      std::vector<std::string> names, MechanismOptions options = {});

  const std::vector<std::string>& names() const { return names_; }  ///< names of θ
  /// θ as the scene has it.
  const Eigen::VectorXd& own() const { return own_; }
  /// The scene, drives included. @throws SceneError
  Scene scene(const Eigen::VectorXd& values) const;
  /// The mechanism, drives held as at t = 0. @throws SceneError
  std::unique_ptr<Mechanism> at(const Eigen::VectorXd& values) const;
  /// The scene's text with these numbers in place, all else as it was; the scene written anew where
  /// that fails.
  std::string text(const Eigen::VectorXd& values) const;

 private:
  std::vector<Setting> settings(const Eigen::VectorXd& values) const;
  double own_number(const Scene& own, const std::string& name) const;
  std::string text_, file_;
  std::vector<Setting> fixed_;
  std::vector<std::string> names_;
  MechanismOptions options_;
  Eigen::VectorXd own_;
};

}  // namespace momenta
