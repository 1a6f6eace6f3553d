#pragma once
// The same mechanism with other joints cut: joints made loops, loops made joints, every body where
// it was and as fast. What is cut changes no motion; it changes how many loop equations are open at
// once in the sweeps and how deep the tree is (cycles.h).
//
// A loop may become a joint of its kind (a point or spherical loop of a planar mechanism: a hinge)
// if it has one, is not driven and its bodies stand as that joint lets them. A joint may become a
// loop of its kind if nothing is said of its coordinates: no drive, spring, damper, torque or
// coupler, not held by [assembly]. Free and helical joints are no loops, distances and couplers no
// joints. `keep` names further joints and loops to leave as they are.
//
// Joints keep their names, their axes and, if seen from the other body now, their q and u; the two
// coordinates of a universal joint then change places, and those of planar, spherical and free
// joints are others, as remarks of the new scene tell.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/start.h>
#include <momenta/dae/topology/cut/cut_cost.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

struct Recut {
  std::vector<std::string> cut;     ///< joints that became loops, in the order of the scene
  std::vector<std::string> joined;  ///< loops that became joints
  bool reordered = false;           ///< trees on the ground stand in another order (tree_order.h)
  bool children_reordered = false;  ///< so do children of bodies (tree_order.h)
  CutCost before, after;
  Scene scene;  ///< with the remarks; the given one where nothing is gained
  /// Mechanism of `scene` with the algebra of the given one, else default options; null where
  /// nothing is gained.
  std::shared_ptr<const Mechanism> mechanism;
  bool gains() const { return !cut.empty() || reordered || children_reordered; }
};

/// "cut at 'J3', with 'end' in the tree"; empty where nothing is gained.
std::string in_words(const Recut& recut);

/// The best cuts found, and the best order of the trees on the ground and of children: by descent
/// from the given tree, a shallow and a deep one; those given where that lowers neither the cost of
/// the sweeps by two hundredths nor, at as much more, the entries of M by a quarter. Where the
/// sweeps can't carry the loops, the entries of L decide. Bounded effort: some seconds for a
/// hundred thousand bodies.
/// @throws SceneError where `keep` names neither a joint nor a loop
Recut recut(const Mechanism& mechanism, const Start& start,
            const std::vector<std::string>& keep = {});

}  // namespace momenta
