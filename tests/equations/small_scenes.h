#pragma once
// Any small mechanism, sound or odd, from a string of bytes; and what the program must do with it:
// run it, or refuse it in one sentence.

#include <momenta/core/scene/scene.h>

#include <span>
#include <string>

namespace momenta::equations {

/// Up to six bodies, joints and loops of every kind, drives, springs, dampers, wrenches; redundant
/// loops, bodies without mass, points that coincide, factors of 1e-12 to 1e12 among them. Not every
/// one is valid, few can be assembled in one way only.
Scene small_scene(std::span<const unsigned char> bytes);

/// A sound one: closed loops at the start, moderate numbers, no drives. Whether it is regular is
/// for the caller to see. `planar`: hinges alone, one chain closed to the ground, at rest.
Scene sound_scene(std::span<const unsigned char> bytes, bool planar = false);

/// Joints and loops, a line each: for the reader of a failure.
std::string outline(const Scene& scene);

/// The same bytes' choice of form.
std::string form_for(std::span<const unsigned char> bytes);

struct Tried {
  std::string wrong;  ///< empty: all as it should be
  bool ran = false;   ///< to the end
};
/// Checks, assembles and runs a scene for so many seconds, and at most so many of a processor, in
/// one form: each of these has to give finite results or one sentence.
Tried try_scene(const Scene& scene, const std::string& form, double seconds = 0.1);

}  // namespace momenta::equations
