#pragma once
// Chains whose states are hard on rounding, or look so.

#include <momenta/core/scene/scene.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta::stability {

struct Case {
  std::string name;
  int n = 0;
  int steps = 0;  ///< of RK4 in 1 s; 0: only single evaluations
  /// Joint angles are drawn from ± this [rad], rates from ± 1 rad/s.
  double spread = 0;
  /// The scene of a seed: masses drawn at random differ from seed to seed, nothing else.
  std::function<Scene(unsigned seed)> scene;
};

std::vector<Case> cases();

}  // namespace momenta::stability
