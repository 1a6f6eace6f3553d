#pragma once
// A scene driven to extremes, and a scene in other units. Both are scenes again: whatever runs the
// one runs the other.
//
// In other units, lengths s, times τ and masses μ stand for one metre, second and kilogram. Every
// quantity of the scene takes the factor of its dimension: gravity s/τ², inertia μs², a spring
// μ/τ², a spring of a joint that turns μs²/τ², and so on. The motion is the same: q(t) of the one
// is q(τt) of the other, lengths times s. Two of the extremes are of this kind and so have an exact
// answer:
//
//   size f     s = f, τ = √f, μ = 1: gravity stays what it is
//   speed f    from rest: τ = 1/f, forces and weights grow like f²
//
// The others change the problem:
//
//   stiffness f    every spring times f
//   damping f      every damper times f; a scene without gets one at each joint of one coordinate,
//                  that takes the speed of the whole about a second to lose at f = 1
//   mass ratio f   every second body times f, in the order of the file
//   speed f        in motion at the start: its rates times f, gravity and springs as they are
//   duration f     end times f
//
// At a speed f the end comes f times sooner: the way travelled stays comparable.

#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta {

/// What one metre, second and kilogram of a scene become; all positive and finite.
struct Units {
  double length = 1, time = 1, mass = 1;
};
Scene in_units(Scene scene, const Units& units);

/// The same scene in a room turned by `rotation`: ground's axes are others, the motion is the same.
/// @pre no drive moves a loop's point of the ground
Scene turned(Scene scene, const Eigen::Quaterniond& rotation);

enum class Extreme { stiffness, damping, mass_ratio, size, speed, duration };
const char* name_of(Extreme extreme);

/// Why a scene has no such extreme: nothing of the kind in it; empty when it has.
std::string lacks(const Scene& scene, Extreme extreme);

/// `scene` with one of its directions times `factor`. @pre lacks() is empty, factor > 0
Scene driven_to(const Scene& scene, Extreme extreme, double factor);

}  // namespace momenta
