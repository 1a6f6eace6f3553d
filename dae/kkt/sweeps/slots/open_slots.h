#pragma once
// Slots in use, front by front: in a pack of states each slot is a pack of its own, and work on
// slots of no open loop would be wasted. Slots stand in groups of two.

#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>

namespace momenta {

using SlotGroups = unsigned;  ///< bit g: slots 2g and 2g + 1

struct OpenSlots {
  struct Front {
    SlotGroups all = 0;    ///< groups open at the body, with those it closes
    SlotGroups open = 0;   ///< going on to its parent
    SlotGroups fresh = 0;  ///< not brought by its first child
    SlotGroups slot = 0;   ///< brought by its other children
    SlotGroups born = 0;   ///< brought by no child, where no loop closes
    bool brought = false;  ///< other children bring loops, or close them
    /// Groups open where it is gathered with its later siblings (roots: at the ground), and those
    /// of them not brought by these.
    SlotGroups gathered = 0, gathered_fresh = 0;
  };
  std::vector<Front> fronts;       ///< per body
  std::vector<SlotGroups> beside;  ///< per loop: open once it has closed

  /// From the parents of all bodies and the rows of all loops. O(length of all loops). Out of line
  /// like the destructor: the sweeps that call them are compiled for several instruction levels.
  /// @pre plan.fits()
  OpenSlots(const LoopPlan& plan, const std::vector<int>& parents, const std::vector<int>& rows);
  ~OpenSlots();
  OpenSlots(const OpenSlots&) = delete;
  OpenSlots& operator=(const OpenSlots&) = delete;
};

template <class Tree>
__attribute__((always_inline)) inline std::vector<int> parents_of(const Tree& tree) {
  std::vector<int> parents(tree.links.size());
  for (std::size_t k = 0; k < parents.size(); ++k) parents[k] = tree.links[k].parent;
  return parents;
}
template <class Loops>
__attribute__((always_inline)) inline std::vector<int> rows_of(const Loops& loops) {
  std::vector<int> rows(loops.loops.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = loops.loops[i].rows;
  return rows;
}

}  // namespace momenta
