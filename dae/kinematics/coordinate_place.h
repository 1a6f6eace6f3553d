#pragma once
// Where a coordinate that is named stands in q and u.

#include <momenta/dae/mechanism.h>

#include <string>
#include <utility>

namespace momenta {

/// Places in q and u of a coordinate by its joint's name, "O", or by that of its column, "J.q2".
/// @throws SceneError where it is not known, or is part of a quaternion: the sentence names those
/// that are
std::pair<int, int> coordinate_place(const Mechanism& mechanism, const std::string& name);

}  // namespace momenta
