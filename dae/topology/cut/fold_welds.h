#pragma once
// Two bodies as one. With R, r the turn and origin of the second one's frame in the first's,
//
//   m = m₁ + m₂,  c = (m₁ c₁ + m₂ c₂') / m,  c₂' = r + R c₂
//   I = I₁ + R I₂ Rᵀ + m₁ m₂ / m (d² 1 − d dᵀ),  d = c₂' − c₁

#include <momenta/core/scene/scene.h>
#include <momenta/dae/topology/cut/folded_scene.h>

namespace momenta {

/// `first` with the mass of `second`; its shape, which would be drawn about another centre, goes.
BodySpec merged_body(BodySpec first, const BodySpec& second, const Eigen::Quaterniond& turn,
                     const Eigen::Vector3d& origin);

// The same mechanism without the bodies that weld joints carry: each is part of the first body
// towards the ground that moves by a joint of its own, its carrier, or of the ground. With R, r the
// turn and origin of the body's frame in the carrier's,
//
//   point  x' = r + R x,   direction  a' = R a,   masses: fold_welds.h
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

/// O((bodies + loops + forces) log), times at most the number of welds that have to stay. A scene
/// of welds alone stays as it is. @throws SceneError where validate() would
FoldedScene fold_welds(const Scene& scene);

}  // namespace momenta
