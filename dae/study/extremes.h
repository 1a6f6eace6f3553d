#pragma once
// A scene with one of its properties made extreme, and a scene in other units. The results are
// scenes again, to be run like any other.
//
// In other units, lengths s, times τ and masses μ stand for one metre, second and kilogram. Every
// quantity of the scene is multiplied by the factor of its dimension: gravity by s/τ², inertia by
// μs², the stiffness of a spring by μ/τ², that of a revolute joint by μs²/τ², and so on. The motion
// is the same: q(t) of the one is q(τt) of the other, lengths times s. Two of the extremes are of
// this kind and so have an exact solution:
//
//   size f     s = f, τ = √f, μ = 1: gravity stays what it is
//   speed f    from rest: τ = 1/f, forces and weights grow like f²
//
// The others change the problem:
//
//   stiffness f    every spring times f
//   damping f      every damper times f; a scene without dampers gets one at each joint of one
//                  coordinate, such that the whole loses its speed in about a second at f = 1
//   mass ratio f   every second body times f, in the order of the file
//   speed f        in motion at the start: its rates times f, gravity and springs as they are
//   duration f     end times f
//
// At speed f the end time is f times smaller, so that the distance travelled stays comparable.

#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta {

/// Values of one metre, second and kilogram in the new units; positive, finite.
struct Units {
  double length = 1, time = 1, mass = 1;
};
/// @pre no formulas in the scene
Scene in_units(Scene scene, const Units& units);

/// The same scene in a room turned by `rotation`: ground's axes are others, the motion is the same.
/// @pre no drive moves a loop's point of the ground, no formula takes a marker's place
Scene turned(Scene scene, const Eigen::Quaterniond& rotation);

enum class Extreme { stiffness, damping, mass_ratio, size, speed, duration };
const char* name_of(Extreme extreme);

/// Reason why a scene has no such extreme; empty: it has.
std::string lacks(const Scene& scene, Extreme extreme);

/// `scene` with one of its directions times `factor`. @pre lacks() is empty, factor > 0
Scene driven_to(const Scene& scene, Extreme extreme, double factor);

}  // namespace momenta
