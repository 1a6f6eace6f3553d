#pragma once
// A picture and its motions as data of a page, small enough to inline.
//
// A motion is one string of 16-bit integers, little endian, base64, track after track of `count`
// numbers. Body by body: the angle about its axis in units of 2π/65536, which wraps, or the four
// parts w x y z of its rotation in units of 1/32767, or nothing; then, where its joint slides, x y
// z of the slide in units of translation_scale/32767. Loop by loop: the gap in units of
// gap_scale/32767, in the plane along its two directions, else x y z.
//
// An angle is exact to 5·10⁻⁵ rad; the tip of a chain of N links of length l to 5·10⁻⁵ N l, below a
// pixel of a window that shows the chain. Joints stay closed (picture.h).

#include <momenta/dae/run/picture.h>

#include <nlohmann/json.hpp>

namespace momenta {

inline constexpr std::size_t most_bodies_drawn = 2000;

nlohmann::ordered_json picture_json(const Picture&);
/// {run, start, every, count, translation_scale, gap_scale, data}
nlohmann::ordered_json motion_json(const Picture&, const Motion&);

/// A power of two: films of `runs` runs together stay below about 1 MB; 0 where that shows too
/// little.
int film_intervals(const Picture&, std::size_t runs);

}  // namespace momenta
