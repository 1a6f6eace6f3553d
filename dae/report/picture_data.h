#pragma once
// A picture and its motions as the data of a page: small enough to be inlined.
//
// A motion is one string of 16-bit integers, little endian, base64, track after track, each track
// `count` numbers long. Body by body: the angle about its axis in units of 2π/65536, which wraps
// where it should, or the four parts w x y z of its turn in units of 1/32767, or nothing; then,
// where its joint slides, x y z of the slide in units of translation_scale/32767. Loop by loop: the
// gap in units of gap_scale/32767, in the plane along its two directions, else x y z.
//
// An angle is told to 5·10⁻⁵ rad; a tip at the end of a chain of N links of length l is drawn
// within 5·10⁻⁵ N l, below a pixel of any window that shows the chain. Joints are exact whatever
// the rounding (picture.h).

#include <momenta/dae/study/picture.h>

#include <nlohmann/json.hpp>

namespace momenta {

/// Larger mechanisms are not drawn.
inline constexpr std::size_t most_bodies_drawn = 2000;

nlohmann::ordered_json picture_json(const Picture&);
/// {run, start, every, count, translation_scale, gap_scale, data}
nlohmann::ordered_json motion_json(const Picture&, const Motion&);

/// Intervals of films, a power of two, so that the films of `runs` runs together stay below about
/// 1 MB of a page; 0 where that were too few to show anything.
int film_intervals(const Picture&, std::size_t runs);

}  // namespace momenta
