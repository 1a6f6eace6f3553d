#pragma once
// Makes the picture of a mechanism, and its motion from the coordinates of a film.

#include <momenta/dae/mechanism.h>
#include <momenta/dae/study/picture.h>

namespace momenta {

Picture picture_of(const Mechanism& mechanism);

/// Cost O(bodies + loops) a frame.
Motion motion_of(const Mechanism& mechanism, const Film& film);

/// Every 2ⁿ-th frame, as few as show the motion: between two frames no body turns by more than 0.2
/// rad, none is carried further than 0.1 lengths of the scene. At least about 100 are kept.
void thin(Motion& motion, const Picture& picture);

/// Largest turn of a body against its parent between two frames [rad]: from a quarter turn on what
/// lies between them cannot be told.
double largest_turn(const Motion& motion);

/// Ground place of every body at a frame, as the head of picture.h has it.
std::vector<Eigen::Isometry3d> places(const Picture& picture, const Motion::Frame& frame);

}  // namespace momenta
