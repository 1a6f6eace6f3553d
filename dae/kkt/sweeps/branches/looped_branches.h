#pragma once
// Folded branches of one shape, as those of a platform. Branches do not know of each other: each
// brings the body it ties to no more than
//
//   M*_L += Jᵀ W⁻¹ J,  D_L += Jᵀ W⁻¹ d
//
// (front.h), and takes that body's motion back. So the sweeps take several at once, one in each
// lane of a vector register, before and after the rest of the mechanism is swept body by body: a
// single state has the lanes of a batch then, with other constants in each.
//
// Two branches have one shape when their joints are of the same kinds, in the same order from the
// ground, and their loops tie the same places in the same way.

#include <momenta/core/kernel/link.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

#include <string>

namespace momenta {

/// Up to `lanes` branches that fold into one body.
struct LoopedBranchGroup {
  int onto = -1;              ///< the body
  int lanes = 0, count = 0;   ///< lanes, and those in use; the others repeat the last
  int bodies = 0, loops = 0;  ///< number in one branch
  std::vector<int> roots;     ///< by lane; a branch's bodies follow its root
  std::vector<int> loop;      ///< indices in the model, at [i · lanes + lane]
  LoopPlan plan;              ///< plan of one branch: body 0 that it folds into, its own from 1 on
};

struct LoopedBranchGroups {
  std::vector<LoopedBranchGroup> groups;
  std::vector<char> bodies, loops;  ///< whether a body or a loop of the model is in a group

  // Out of line: the sweeps that own one are compiled for several instruction levels.
  LoopedBranchGroups();
  ~LoopedBranchGroups();
  LoopedBranchGroups(LoopedBranchGroups&&) noexcept;
  LoopedBranchGroups& operator=(LoopedBranchGroups&&) = delete;
};

/// Most equations of a branch: what its pack has lanes for.
constexpr int most_looped_branch_rows = 4;

/// Branches in a register of a level's: native_width.
constexpr int looped_branch_lanes_at(int level) {
  return level >= 4 ? 8 : level >= 3 ? 4 : 2;
}

/// The folded branches of a plan worth taking `lanes` at a time: chains of revolute joints and
/// prismatic joints without drives, tied by few enough rows. O(bodies + loops log loops).
LoopedBranchGroups find_looped_branches(const LinkTree& tree, const LoopModel<Spatial>& loops,
                                        const LoopPlan& plan, int lanes);

/// "6 branches of 3 bodies side by side in 8 lanes", or nothing.
std::string looped_branches_in_words(const LoopedBranchGroups& looped_branches);

}  // namespace momenta
