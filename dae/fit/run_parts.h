#pragma once
// Parts of a run: last(g), integral(g) = ∫ g dt and mean(g), with the exact derivatives of the
// run's own steps (dae/gradient/gradient.h). A run takes its largest and smallest values at times
// that these derivatives do not tell: max and min are refused.

#include <momenta/dae/fit/motion_parts.h>
#include <momenta/dae/gradient/gradient.h>

namespace momenta {

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

 private:
  SceneText scene_;
  RunSettings settings_;
  std::vector<MotionPart> parts_;
  std::vector<std::string> remarks_;
};

}  // namespace momenta
