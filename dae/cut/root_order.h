#pragma once
// The order of the trees that stand on the ground. It changes no motion, but at the ground a loop
// between two of them is open from the one to the other, over all that stand between in the order
// of the scene, and a branch folds only onto what stands before it (sweeps/slots/loop_plan.h). With
// the trees as vertices and their loops as edges, wanted is an order of small bandwidth: that of
// Cuthill and McKee, breadth first, those of fewest ties first. It begins at an end of the graph,
// as far from another vertex as that from it; or at the vertex of most ties, where branches fold
// onto one.
//
// Source: Cuthill, McKee, Proc. 24th ACM National Conference (1969) 157.

#include <momenta/core/scene/scene.h>

#include <vector>

namespace momenta {

/// The scene in either order, unless that is its own or the one before: the joints of the ground,
/// and the loops in the order of the first tree they tie, seen from it. O((bodies + loops) log)
std::vector<Scene> with_roots_ordered(const Scene& scene);

}  // namespace momenta
