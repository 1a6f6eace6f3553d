#pragma once
#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// Rods whose pins miss their ends, one sentence each: a length changed in only one of two places.
/// Pins: joints, loops with points and springs, on the rod's axis within 1e-6 of its length; rods
/// with fewer than two are left out. O(scene)
std::vector<std::string> rods_that_miss_their_pins(const Scene& scene);

}  // namespace momenta
