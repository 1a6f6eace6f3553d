#pragma once
// The order of the children of a body. It changes no motion, but their fronts are gathered one
// after the other, last child first, and a loop that closes there is open over all that come
// between its ends (sweeps/slots/loop_plan.h). Children that loops tie together stay side by side,
// breadth first from an end (cut_cost.h). Of such groups, g with at most P_g loops open while it
// is gathered and R_g that go on above the body, those of larger P_g − R_g come first to be
// gathered: the order in which the largest sum of the R before and the own P is least (Liu, for the
// stack of multifrontal methods).
//
// Source: Liu, ACM TOMS 12 (1986) 249.

#include <momenta/core/scene/scene.h>

#include <optional>
#include <vector>

namespace momenta {

/// The scene with joints below bodies in this order; nothing where they are. Joints on the ground
/// stay (tree_order.h). O(length of all loops + bodies log)
std::optional<Scene> with_children_ordered(const Scene& scene);

// The order of the trees that stand on the ground. It changes no motion, but at the ground a loop
// between two of them is open from the one to the other, over all that stand between in the order
// of the scene, and a branch folds only onto what stands before it (sweeps/slots/loop_plan.h). With
// the trees as vertices and their loops as edges, wanted is an order of small bandwidth: that of
// Cuthill and McKee, breadth first, those of fewest ties first. It begins at an end of the graph,
// as far from another vertex as that from it; or at the vertex of most ties, where branches fold
// onto one.
//
// Source: Cuthill, McKee, Proc. 24th ACM National Conference (1969) 157.

/// The scene in either order, unless that is its own or the one before: the joints of the ground,
/// and the loops in the order of the first tree they tie, seen from it. O((bodies + loops) log)
std::vector<Scene> with_roots_ordered(const Scene& scene);

}  // namespace momenta
