#pragma once
// Makes the picture of a mechanism, and its motion from the coordinates of a film.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/picture.h>

namespace momenta {

Picture picture_of(const Mechanism& mechanism);

/// O(bodies + loops) a frame.
Motion motion_of(const Mechanism& mechanism, const Film& film);

/// Keeps every 2ⁿ-th frame, at least about 100, so that between two no body turns by more than 0.2
/// rad or is carried further than 0.1 lengths of the scene.
void thin(Motion& motion, const Picture& picture);

/// Largest turn of a body against its parent between two frames [rad]: from a quarter turn on the
/// motion between is ambiguous.
double largest_turn(const Motion& motion);

/// Ground pose of every body at a frame, by the head of picture.h.
std::vector<Eigen::Isometry3d> places(const Picture& picture, const Motion::Frame& frame);

}  // namespace momenta
