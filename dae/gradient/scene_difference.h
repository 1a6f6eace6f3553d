#pragma once
// Whether a scene differs from a given one in nothing but numbers by which number_slopes.h has
// derivatives.

#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

enum class Change {
  inertias_and_forces,  ///< bodies, gravity, springs, dampers, wrenches, bushings: no part of the
                        ///< assembly
  places,               ///< joints, loops and springs, perhaps also the above
  drives,               ///< laws of drives of joints, perhaps also the above
  more                  ///< anything else
};

/// Springs and dampers linear in one length, or also dead bands, stops, wrenches and bushings.
enum class Forces { plain, all };

class SceneDifference {
 public:
  /// Differences beyond `known` or in other forces are `more`. The scene must outlive it.
  SceneDifference(const Scene& scene, Change known, Forces forces);
  /// O(text of the scene)
  Change of(Scene other) const;

 private:
  const Scene& scene_;
  Change known_;
  Forces forces_;
  std::string text_;
  std::vector<std::string> formulas_;
};

}  // namespace momenta
