#pragma once
// One mechanism, written otherwise: the same bodies in the same motion. What a body's frame is, in
// which order bodies, joints and loops stand, which way an axis points and its coordinate counts,
// whether a body is one or two welded, a rotor a number or a wheel behind a gear, which joints are
// cut, and how the room lies, is a matter of writing. None of it changes where the markers are, how
// fast they are or how they are accelerated.
//
// Every function takes a scene whose numbers are those of its start (at_start()) and leaves one.
// Drives, forces, couplers and markers follow. What of other trees there is: other_trees.h.

#include "equations/random_tree.h"

namespace momenta::equations {

/// Bodies, joints, loops, drives and forces in another order; markers keep theirs.
void permute(RandomTree& random, Scene& scene);

/// Other frames of all bodies: origins and axes.
void move_frames(RandomTree& random, Scene& scene);

/// Axes of joints reversed, their coordinates counted the other way; axes of loops reversed.
void flip_axes(RandomTree& random, Scene& scene);

/// Loops seen from their other body.
void turn_loops_round(RandomTree& random, Scene& scene);

/// Bodies in two parts, one welded to the other: what a body carries hangs on either, its mass is
/// on either or shared.
void split_bodies(RandomTree& random, Scene& scene);

/// A body welded to the ground, with a mass or none, that carries some of what the ground does.
void add_base(RandomTree& random, Scene& scene);

/// Each rotor inertia I as a wheel on the ground that turns n times as fast as its coordinate, with
/// the inertia I/n², behind a coupler of n to one. In a plane it turns in the plane. Rotors on
/// balls stay: no wheel turns with them.
void turn_rotors_into_wheels(RandomTree& random, Scene& scene);

/// Couplers with their terms in another order, all times a factor.
void rewrite_gears(RandomTree& random, Scene& scene);

}  // namespace momenta::equations
