#pragma once
// Scenes to time: the families of the paper's table and of the loops' literature, made in memory.

#include <momenta/core/scene/scene.h>

namespace momenta::benchmark_models {

/// n bodies in series on revolute joints; axes and offsets at random (seeded), inclined to each
/// other by 17° or more; or every axis at a right angle to the last.
Scene random_chain(int n);
Scene right_angle_chain(int n);
/// The random chain with every other revolute joint a slide along its axis; with a screw of 0.1
/// m/rad in place of every revolute joint.
Scene prismatic_and_revolute_chain(int n);
Scene helical_chain(int n);
/// n rods of 0.1 m on revolute joints that turn by a quarter from one to the next, nearly straight.
Scene rope(int n);
/// n rods in a plane.
Scene planar_chain(int n);
/// A full binary tree of revolute joints.
Scene binary_tree(int n);
/// A free body with legs of six revolute joints, n bodies in all.
Scene star(int n);
/// A free trunk with two legs of six hinges, two arms of seven, three in the torso, one in the
/// neck: 31 bodies whatever n. Axes along the trunk's, two or three at a place.
Scene humanoid(int n);
/// n bodies on spherical joints.
Scene spherical_chain(int n);

/// One loop, three rods.
Scene four_bar();
/// N four-bars in a row, 2N + 1 rods, N loops.
Scene n_four_bar(int n);
/// A ladder of n pairs of crossed bars, 2n bars, n − 1 loops that reach over two pairs each.
Scene scissor_ladder(int n);

}  // namespace momenta::benchmark_models
