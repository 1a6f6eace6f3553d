#pragma once
// A platform on six rods. Of the pieces of a mechanism (pieces.h) two stand out: the base, of which
// the ground is, and the platform, which most ties meet. Between them are chains of ties, each a
// loop of kind distance or a leg that asks the same (platform_rod.h).

#include <momenta/dae/kinematics/platform_rod.h>

#include <vector>

namespace momenta {

struct PlatformLegs {
  int platform = -1;              ///< the piece
  std::vector<PlatformRod> rods;  ///< six; their chains are of ties of the pieces
};

/// @throws SceneError naming the joint, loop or body that makes it another mechanism
PlatformLegs platform_legs(const Mechanism& mechanism, const Pieces& pieces);

}  // namespace momenta
