#pragma once
// What a scene differs in from a given one: whether in nothing but numbers that number_slopes.h has
// derivatives by.

#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// Kinds of differences.
enum class Change {
  inertias_and_forces,  ///< of bodies, gravity, springs, dampers, wrenches, bushings: the assembly
                        ///< knows none of them
  places,               ///< of joints, loops and springs, with or without these
  drives,               ///< of joints, their laws, with or without these
  more                  ///< anything else
};

/// Which forces: springs and dampers linear in one length, or dead bands, stops, wrenches and
/// bushings too.
enum class Forces { plain, all };

class NumbersAlone {
 public:
  /// `known`: a difference beyond is more, and so is one in other forces. The scene must outlive
  /// it.
  NumbersAlone(const Scene& scene, Change known, Forces forces);
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
