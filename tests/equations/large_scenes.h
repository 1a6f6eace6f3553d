#pragma once
// Mechanisms of any size with short loops on a deep tree, and with one long loop: plane, closed at
// the start. A row of four-bars, short loops on a shallow tree, is in linkages.h.

#include <momenta/core/scene/scene.h>

namespace momenta::equations {

/// n pairs of crossed bars of 2 m, one on another, n − 1 loops; the tree is 2n deep.
Scene crossed_bars(int n);

/// n rods on an arc between two fixed points: one loop.
Scene arch(int n);

/// n rods of 1 m in line along x from the ground, the last one's tip to be held at (reach, 0, 0);
/// hinges, or spherical joints.
Scene stretched_chain(int n, double reach, bool spherical = false);

}  // namespace momenta::equations
