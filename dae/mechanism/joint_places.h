#pragma once
// The joints of a mechanism by name, with the places of their numbers in q and u. A joint may be
// carried by several bodies of the tree that share its name; its numbers are theirs in tree order.
// For a Lagrangian: its coordinates.

#include <momenta/dae/mechanism/mechanism.h>

#include <string>
#include <vector>

namespace momenta {

struct JointPlace {
  std::string name;
  std::vector<int> q;            ///< places in q
  std::vector<int> u;            ///< places in u, p and all that goes with them
  std::vector<int> quaternions;  ///< places in q where a quaternion w x y z starts
  std::vector<int> drives;       ///< indices into Tree::drives, by coordinate of the joint
  int body = -1;  ///< −1: none; the last body of the joint, the one the scene's joint carries
};

/// All joints, in tree order of their first bodies. O(bodies log joints).
std::vector<JointPlace> joint_places(const Mechanism& mechanism);

}  // namespace momenta
