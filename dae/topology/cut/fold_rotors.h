#pragma once
// The same mechanism without the bodies of rotors: wheels that a gear turns with a joint. A rotor R
// on a revolute joint from B, its centre of mass on the axis a, J = aᵀ I a its moment about it
// (with the rotor inertia of its own joint), turns at u_R = ρ u with coordinate q of a joint j,
// since a coupler says r_R q_R + r q = offset, ρ = −r / r_R. With ω the angular velocity of B,
//
//   T_R = ½ m v² + ½ (ω + a ρ u)ᵀ I (ω + a ρ u)
//
// Where B does not turn (the ground, or what slides from it), ω = 0: there R is its mass on B and
// I_r = J ρ² on the rate of j (core/kernel/rotor.h), exactly, symmetric or not.
//
// Where B turns, R symmetric, T_R is that of R fixed to B, and J ρ (ω·a) u + ½ J ρ² u². Let j be
// one of B's own joints, about the axis a, C its other body, ω_C·a = ω·a + u where j leads from B
// to C. Then (ω·a) u = ½ ((ω_C·a)² − (ω·a)² − u²), and so, with K = J ρ,
//
//   T_R = T(R fixed to B) − ½ K (ω·a)² + ½ K (ω_C·a)² + ½ (J ρ² − K) u²                     (*)
//
// K a aᵀ of moments of inertia goes from B to C, which rigid bodies need not have (any_inertia),
// and I_r = J ρ² − K. Where j leads from C to B, u counts the other way, K = −J ρ; likewise where
// its axis is −a. Asked for is that I_r ≥ 0 (no ratio between 0 and 1) and that the moments of the
// body that gives stay positive.
//
// The joint of R hands on to j, if that has one coordinate,
//
//   damping d ρ²,  torque τ ρ,  stiffness k ρ² at rest (q_rest − offset / r_R) / ρ
//
// Rotors behind rotors fold one after the other. Left as they are: rotors with children, loops,
// springs or wrenches on them; in two couplers, or in one of three joints, such as a differential;
// behind a driven coupler; driven ones; on a body that turns, behind another joint than its own or
// about another axis; and whatever else a coupler ties (a crank, a slide): where its moment of
// inertia depends on its angle, no number on a rate stands for it.

#include <momenta/dae/topology/cut/folded_scene.h>

namespace momenta {

/// Markers on rotors are not in the folded scene: their points are not fixed in any body of it.
/// O((bodies + loops + forces) log). @throws SceneError where validate() would
FoldedScene fold_rotors(const Scene& scene);

/// fold_welds(), then fold_rotors().
FoldedScene fold(const Scene& scene);

}  // namespace momenta
