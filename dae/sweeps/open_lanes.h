#pragma once
// Which lanes are in use where: of a pack of states each lane is a pack of its own, and work on
// lanes of no open loop would be work for nothing. Lanes stand in groups of two.

#include <momenta/dae/sweeps/loop_plan.h>

namespace momenta {

using LaneGroups = unsigned;  ///< bit g: lanes 2g and 2g + 1

struct OpenLanes {
  struct Front {
    LaneGroups all = 0;                       ///< of loops open at the body, those it closes too
    LaneGroups open = 0;                      ///< of those that go on to its parent
    LaneGroups fresh = 0;                     ///< of those its first child did not bring
    LaneGroups slot = 0;                      ///< of those its other children bring
    LaneGroups born = 0;                      ///< of those no child brought, where no loop closes
    LaneGroups ground = 0, ground_fresh = 0;  ///< at the ground, when this root arrives
  };
  std::vector<Front> fronts;       ///< per body
  std::vector<LaneGroups> beside;  ///< per loop: of those still open once it has closed

  /// From the parents of all bodies and the rows of all loops. O(length of all loops). Out of line
  /// like the destructor: the sweeps that call them are compiled for several instruction levels.
  /// @pre plan.fits()
  OpenLanes(const LoopPlan& plan, const std::vector<int>& parents, const std::vector<int>& rows);
  ~OpenLanes();
  OpenLanes(const OpenLanes&) = delete;
  OpenLanes& operator=(const OpenLanes&) = delete;
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
