#pragma once
// Descriptions (descriptions.h) with another tree: which joints are cut, which body flies, how the
// room lies.

#include "equations/descriptions.h"

#include <string>

namespace momenta::equations {

/// The scene with the positions and rates of an assembled start, met to rounding. @throws
/// SceneError where it cannot be assembled
Scene at_start(const Scene& scene);

/// Any spanning tree: loops made joints and joints made loops, as far as they can be, each as
/// likely; joints turned to point away from the ground. The scene itself where a joint cannot be
/// turned.
void cut_elsewhere(RandomTree& random, Scene& scene);

/// A free joint carries another body of its subtree, if it carries one that nothing drives.
void root_elsewhere(RandomTree& random, Scene& scene);

/// A scene, and by what its room is turned.
struct Description {
  Scene scene;
  Eigen::Quaterniond room = Eigen::Quaterniond::Identity();
  std::string how;  ///< what was done, in words
};

/// How many ways of writing there are; each alone: description(scene, way, seed).
int ways_of_writing();
const char* name_of_way(int way);
Description description(const Scene& scene, int way, unsigned seed);
/// Several of them one after the other, which and in which order by seed.
Description description(const Scene& scene, unsigned seed);

}  // namespace momenta::equations
