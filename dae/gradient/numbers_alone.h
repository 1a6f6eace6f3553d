#pragma once
// What a scene differs in from a given one: whether in nothing but numbers that number_slopes.h has
// derivatives by.

#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// Kinds of differences.
enum class Change {
  inertias_and_forces,  ///< of bodies, gravity, springs and dampers: the assembly knows none of
                        ///< them
  places,               ///< of joints, loops and springs, with or without these
  more                  ///< anything else
};

class NumbersAlone {
 public:
  /// `of_places` false: a difference in places is more. The scene must outlive it.
  NumbersAlone(const Scene& scene, bool of_places);
  /// O(text of the scene)
  Change of(Scene other) const;

 private:
  const Scene& scene_;
  bool of_places_;
  std::string text_;
  std::vector<std::string> formulas_;
};

/// Whether a force is a spring and damper along one length and linear in it.
bool is_plain_spring(const ForceSpec& force);

}  // namespace momenta
