#pragma once
// Loops with their ends in one order. Equations of a loop are components in axes of its parent,
//
//   D_j = b_j · (x_A − x_B),     O_ij = a_i · b_j,
//
// and the same loop seen from its child has them in axes of the other body: the same where it is
// closed, not on the way there. Newton's steps from an open guess then lead to another pose, next
// to it, or in another assembly. So an assembly is made of loops whose parent is the ground or
// stands before the child among the scene's bodies, and does not depend on which end of a loop is
// written as its parent.

#include <momenta/core/scene/scene.h>

#include <optional>

namespace momenta {

/// The scene with the ends of its loops in that order; nothing where it is written so.
/// Driven loops stay, and kinds whose ends cannot change places. O(bodies + loops)
std::optional<Scene> with_ordered_ends(const Scene& scene);

}  // namespace momenta
