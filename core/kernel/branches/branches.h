#pragma once
// Branches: subtrees of revolute joints of one shape, as legs of a walker or arms. Sweeps take
// several at once, one in each lane of a vector register; the remaining tree is swept body by body:
//
//   inward    branches side by side; what arrives at a root's parent is added lane by lane: (43),
//   (44)
//             then the remaining tree
//   outward   the remaining tree; Ω and gravity of every root's parent into the lanes; then the
//   branches
//
// So a single state fills the lanes as a batch does.
//
// Two subtrees have one shape when their children do, pairwise, and either both or neither come
// over a screw about the parent's z. The choice is between few long and many short branches. In
// times of one revolute joint, a pack of c branches of b bodies saves
//   (c − pack_cost)(b − leaf_discount) − c hand_over;
// the shape whose packs save most goes first, then the next among the remaining bodies.

#include <momenta/core/kernel/link.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// Up to `lanes` branches of one shape.
struct BranchGroup {
  /// A body of the shape, depth-first. Names as in Link, indices within the branch.
  struct Place {
    int parent = -1, slot = -1;
    Turn turn = Turn::general;
    bool first = false, leaf = false, opens = false, screwed = false, has_force = false,
         is_curved = false, has_rotor = false;
  };
  std::vector<Place> places;
  int slots = 0;                          ///< number of slots in the branch
  int lanes = 0, count = 0;               ///< lanes, and those in use; the others repeat the last
  std::vector<int> links;                 ///< links of the tree, at [place · lanes + lane]
  std::vector<int> q, u;                  ///< coordinates and rates, likewise
  std::vector<int> remaining_tree_slots;  ///< by branch: slot of the root's parent in the remaining
                                          ///< tree; −1: ground
  std::vector<char> opens;                ///< by branch: the first to reach that slot
  bool one_parent = false;                ///< all roots are on one body
};

struct Branches {
  std::vector<BranchGroup> groups;
  LinkTree remaining_tree;  ///< q and u as in the tree
  std::vector<int> bodies;  ///< by link of the remaining tree: its index in the tree
  Model<Spatial>
      remaining_tree_model;  ///< bodies of the remaining tree, without forces between points
};

/// The branches of a tree worth taking `lanes` at a time; null: none. O(n log n). @pre the tree's
/// model does not move.
std::unique_ptr<Branches> find_branches(const LinkTree& tree, int lanes);

/// "4 of 6 revolute joints and 2 of 3 side by side"; empty: no branches.
std::string branches_in_words(const LinkTree& tree, int lanes);

}  // namespace momenta
