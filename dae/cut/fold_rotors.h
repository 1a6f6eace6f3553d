#pragma once
// The same mechanism without the bodies of rotors: wheels that a gear turns with a joint. A rotor R
// on a revolute joint from B, its centre of mass on the axis a, J = aᵀ I a its moment about it
// (with the rotor inertia of its own joint), turns at u_R = ρ u with coordinate q of a joint j,
// since a coupler says r_R q_R + r q = offset, ρ = −r / r_R. With ω the angular velocity of B,
//
//   T_R = ½ m v² + ½ (ω + a ρ u)ᵀ I (ω + a ρ u)
//
// Where B does not turn (the ground, or what slides from it), ω = 0: there R is its mass on B and
// I_r = J ρ² on the rate of j (core/kernel/rotor.h), exactly, symmetric or not. Of the joint of R
// go to j, if that has one coordinate,
//
//   damping d ρ²,  torque τ ρ,  stiffness k ρ² at rest (q_rest − offset / r_R) / ρ
//
// Rotors behind rotors fold one after the other. Left as they are: rotors with children, loops,
// springs or wrenches on them; in two couplers, or in one of three joints, such as a differential;
// behind a driven coupler; driven ones; and whatever else a coupler ties (a crank, a slide): where
// its moment of inertia depends on its angle, no number on a rate stands for it.

#include <momenta/dae/cut/folded_scene.h>

namespace momenta {

/// Markers on rotors are not in the folded scene: their points are not fixed in any body of it.
/// O((bodies + loops + forces) log). @throws SceneError where validate() would
FoldedScene fold_rotors(const Scene& scene);

/// fold_welds(), then fold_rotors().
FoldedScene fold(const Scene& scene);

}  // namespace momenta
