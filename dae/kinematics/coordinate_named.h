#pragma once
// Coordinates that users name: "O", the only one of joint O, or the name of its column, "J.q2".

#include <momenta/dae/mechanism.h>

#include <string>
#include <utility>

namespace momenta {

/// Places in q and u. @throws SceneError with all names for an unknown one or a part of a
/// quaternion. O(bodies)
std::pair<int, int> coordinate_named(const Mechanism& mechanism, const std::string& name);

}  // namespace momenta
