#pragma once
// The order of the children of a body. It changes no motion, but their fronts are gathered one
// after the other, last child first, and a loop that closes there is open over all that come
// between its ends (sweeps/slots/loop_plan.h). Children that loops tie together stay side by side,
// breadth first from an end (tie_graph.h). Of such groups, g with at most P_g loops open while it
// is gathered and R_g that go on above the body, those of larger P_g − R_g come first to be
// gathered: the order in which the largest sum of the R before and the own P is least (Liu, for the
// stack of multifrontal methods).
//
// Source: Liu, ACM TOMS 12 (1986) 249.

#include <momenta/core/scene/scene.h>

#include <optional>

namespace momenta {

/// The scene with joints below bodies in this order; nothing where they are. Joints on the ground
/// stay (root_order.h). O(length of all loops + bodies log)
std::optional<Scene> with_children_ordered(const Scene& scene);

}  // namespace momenta
