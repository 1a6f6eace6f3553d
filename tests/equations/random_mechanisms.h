#pragma once
// Random mechanisms with loops that are closed at the start: any joints, any loops, in a plane or
// in space, with couplers, rotors and forces; with loops that are driven or written twice, and of
// any masses.

#include "equations/random_tree.h"

namespace momenta::equations {

struct MechanismRecipe {
  int bodies = 6;
  int loops = 2;        ///< at most: as many as leave a free rate
  bool planar = false;  ///< in any plane
  bool couplers = true;
  bool drives = true;
  bool forces = true;
  bool loop_drives = false;  ///< of some loops' own coordinates, from where they are at the start
  bool redundant = false;    ///< a loop is written twice
  int decades = 0;           ///< by up to so many a body, or all of it, is lighter or heavier
};

/// Positions and rates at random, of order one; of quaternions too.
void move_joints(RandomTree& random, Scene& scene);

Scene random_mechanism(RandomTree& random, const MechanismRecipe& recipe);

}  // namespace momenta::equations
