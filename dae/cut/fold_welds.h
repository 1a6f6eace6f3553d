#pragma once
// The same mechanism without the bodies that weld joints carry: each is part of the first body
// towards the ground that moves by a joint of its own, its carrier, or of the ground. With R, r the
// turn and origin of the body's frame in the carrier's,
//
//   point  x' = r + R x,   direction  a' = R a,   masses: merged_body.h
//
// A loop frame F held by the parent and the axes C of the child, C = F Rot(a, q), become
//
//   F' = R_p F R_cᵀ,   a' = R_c a:   F' Rot(a', q) = R_p F Rot(a, q) R_cᵀ = R_p C R_cᵀ
//
// with the same q. A loop whose child is now the ground is turned round. What ties two points of
// one body to each other has no effect and goes: springs and dampers, and forces on the ground.
//
// A weld joint stays where it matters how it is written: where folded its two bodies would be one
// for some loop (its equations are redundant or contradict each other, as they are), and where a
// drive prescribes an origin in the axes, or roll, pitch and yaw of the axes, of what would go.

#include <momenta/dae/cut/folded_scene.h>

namespace momenta {

/// O((bodies + loops + forces) log), times at most the number of welds that have to stay. A scene
/// of welds alone stays as it is. @throws SceneError where validate() would
FoldedScene fold_welds(const Scene& scene);

}  // namespace momenta
