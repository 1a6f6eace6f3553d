#pragma once
// Scenes to time: the families of the paper's table and of the loops' literature, made in memory.

#include <momenta/core/scene/scene.h>

namespace momenta::benchmark_models {

/// n bodies in series on pin joints; axes and offsets at random (seeded), or every axis at a right
/// angle to the last.
Scene random_chain(int n);
Scene right_angle_chain(int n);
/// n rods in a plane.
Scene planar_chain(int n);
/// A full binary tree of pin joints.
Scene binary_tree(int n);
/// n bodies on spherical joints.
Scene spherical_chain(int n);

/// One loop, three rods.
Scene four_bar();
/// N four-bars in a row, 2N + 1 rods, N loops.
Scene n_four_bar(int n);

}  // namespace momenta::benchmark_models
