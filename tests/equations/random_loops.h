#pragma once
// Random loops for random trees: any kind, between any two bodies or the ground, closed or not.

#include "equations/random_tree.h"

#include <array>
#include <map>
#include <optional>
#include <string>

namespace momenta::equations {

/// Those a plane knows, and all.
inline constexpr std::array planar_loop_kinds{
    LoopKind::point,     LoopKind::revolute, LoopKind::spherical, LoopKind::weld,
    LoopKind::prismatic, LoopKind::distance, LoopKind::slot};
inline constexpr std::array loop_kinds{
    // of bodies
    LoopKind::point,     LoopKind::revolute, LoopKind::spherical, LoopKind::weld,
    LoopKind::prismatic, LoopKind::distance, LoopKind::universal, LoopKind::cylindrical,
    LoopKind::planar,    LoopKind::slot};

LoopSpec random_loop(RandomTree& random, const Scene& scene, LoopKind kind);

/// Drives of coordinates and of components of the origin, each chosen by a bit.
void drive_loop(RandomTree& random, Scene& scene, const LoopSpec& l, int coordinates, int origins);

/// Up to three coordinates of joints without quaternions, driven ones among them, but one free at
/// least; none where there is no such coordinate.
std::optional<LoopSpec> random_coupler(RandomTree& random, const Scene& scene);

/// Rotation of every body's axes with all joints at zero.
std::map<std::string, Eigen::Quaterniond> axes_at_zero(const Scene& scene);

/// Turns a random loop so that it stays in the plane with this normal: its hinge along the normal,
/// its slide across it, its frame turned about the normal alone. Points are left at their heights.
LoopSpec into_plane(RandomTree& random, const Scene& scene, LoopSpec l,
                    const Eigen::Vector3d& normal);

/// Poses of the two bodies of a loop at the start.
struct Ends {
  Eigen::Isometry3d child, parent;
};
Ends ends_at_start(const LoopSpec& l, const Scene& scene, const Tree& tree);

/// Moves the parent's point along the normal until both sides lie at one height.
void level(LoopSpec& l, const Scene& scene, const Tree& tree, const Eigen::Vector3d& normal);

/// Moves the parent's point to where the child's is at the start and turns its frame likewise.
void close(LoopSpec& l, const Scene& scene, const Tree& tree);

}  // namespace momenta::equations
