#pragma once
// A platform on six rods. Two pieces of a mechanism (pieces.h) are special: the base, with the
// ground, and the platform, with the most ties. Chains of ties connect them, each a loop of kind
// distance or a leg with the same effect (platform_rod.h).

#include <momenta/dae/kinematics/platform_rod.h>

#include <vector>

namespace momenta {

struct PlatformLegs {
  int platform = -1;
  std::vector<PlatformRod> rods;  ///< six chains of ties of the pieces
};

/// @throws SceneError with the joint, loop or body that does not fit
PlatformLegs platform_legs(const Mechanism& mechanism, const Pieces& pieces);

}  // namespace momenta
