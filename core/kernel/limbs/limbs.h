#pragma once
// Limbs: subtrees of pins of one shape, as legs of a walker, arms, branches of a tree. They do not
// know of each other, so the sweeps take several at once, one in each lane of a vector register,
// while the trunk, all that is left of the tree, is swept body by body as ever:
//
//   inward    limbs side by side; what arrives at a root's parent is added lane by lane: (43), (44)
//             then the trunk
//   outward   the trunk; Ω and gravity of every root's parent into the lanes; then the limbs
//
// A single state has the lanes of a batch then, and the arithmetic of a limb costs nearly the same
// for one lane as for all.
//
// Two subtrees have one shape when their children do, pairwise, and come over a screw about the
// parent's z or not alike. Which shapes to take is a choice between few long and many short limbs.
// In times of one pin, a pack of c limbs of b bodies saves
//   (c − pack_cost)(b − tip_discount) − c hand_over;
// the shape whose packs save most goes first, then the next among the bodies that are left.

#include <momenta/core/kernel/link.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// Up to `lanes` limbs of one shape.
struct LimbGroup {
  /// A body of the shape; depth-first. Names as in Link, indices within the limb.
  struct Place {
    int parent = -1, slot = -1;
    Turn turn = Turn::general;
    bool first = false, tip = false, opens = false, screwed = false, has_force = false;
  };
  std::vector<Place> places;
  int slots = 0;                 ///< within the limb
  int lanes = 0, count = 0;      ///< of these, so many in use; the others repeat the last
  std::vector<int> links;        ///< of the tree, at [place · lanes + lane]
  std::vector<int> q, u;         ///< their coordinates and rates, likewise
  std::vector<int> trunk_slots;  ///< by limb: slot of the root's parent in the trunk; −1: ground
  std::vector<char> opens;       ///< by limb: the first to reach that slot
  bool one_parent = false;       ///< all of one body
};

struct Limbs {
  std::vector<LimbGroup> groups;
  LinkTree trunk;              ///< what is left; q and u as in the tree
  std::vector<int> bodies;     ///< by link of the trunk: its index in the tree
  Model<Spatial> trunk_model;  ///< bodies of the trunk; forces between points are left out
};

/// The limbs of a tree worth taking `lanes` at a time; null when there are none. O(n log n).
/// @pre the tree's model stays where it is.
std::unique_ptr<Limbs> find_limbs(const LinkTree& tree, int lanes);

/// "4 of 6 pins and 2 of 3 side by side", or nothing.
std::string limbs_in_words(const LinkTree& tree, int lanes);

}  // namespace momenta
