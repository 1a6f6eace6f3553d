#pragma once
// The kinds of joints, loops, drives, forces, shapes and visuals, by name.

#include <momenta/core/scene/scene.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace momenta::reading {

// In the order of the enumerations. User joints, the last kind, have no name in files.
inline constexpr std::array<std::string_view, 9> joint_kinds{
    "revolute",  "prismatic", "helical", "cylindrical", "universal",
    "spherical", "planar",    "free",    "weld"};
inline constexpr std::array<std::string_view, 16> loop_kinds{
    "point",    "revolute",  "spherical",   "weld",     "prismatic",
    "distance", "universal", "cylindrical", "planar",   "coupler",
    "slot",     "cam",       "rack",        "equation", "velocity-equation",
    "rolling"};
// A straight slot has no curve.
inline constexpr std::array<std::string_view, 3> function_kinds{"cubic", "monotone", "linear"};
inline constexpr std::array<std::string_view, 3> event_directions{"both", "up", "down"};
inline constexpr std::array<std::string_view, 3> slot_curves{"line", "circle", "spline"};
inline constexpr std::array<std::string_view, 4> cam_curves{"circle", "ellipse", "spline", "flat"};
inline constexpr std::array<std::string_view, 5> drive_kinds{"polynomial", "harmonic", "step",
                                                             "table", "formula"};
inline constexpr std::array<std::string_view, 6> force_kinds{
    "spring-damper", "bushing", "coordinate-spring", "torque", "wrench", "potential"};
inline constexpr std::array<std::string_view, 5> shape_kinds{"rod", "box", "cylinder", "sphere",
                                                             "point"};
inline constexpr std::array<std::string_view, 6> visual_kinds{"box",      "sphere",    "capsule",
                                                              "cylinder", "ellipsoid", "mesh"};

static_assert(static_cast<std::size_t>(JointKind::user) == joint_kinds.size());
static_assert(static_cast<std::size_t>(LoopKind::rolling) + 1 == loop_kinds.size());

inline std::string_view name_of(JointKind kind) {
  return kind == JointKind::user ? "user" : joint_kinds.at(static_cast<std::size_t>(kind));
}
inline std::string_view name_of(LoopKind kind) {
  return loop_kinds.at(static_cast<std::size_t>(kind));
}

constexpr bool has_axis(JointKind kind) {
  return kind != JointKind::spherical && kind != JointKind::free && kind != JointKind::weld &&
         kind != JointKind::user;
}
constexpr bool has_axis(LoopKind kind) {
  return kind == LoopKind::revolute || kind == LoopKind::prismatic || kind == LoopKind::universal ||
         kind == LoopKind::cylindrical || kind == LoopKind::planar || kind == LoopKind::slot ||
         kind == LoopKind::cam || kind == LoopKind::rack || kind == LoopKind::rolling;
}

/// Coordinates of drives that come all together or not at all.
inline constexpr std::array<std::string_view, 6> pose_coordinates{"x",    "y",     "z",
                                                                  "roll", "pitch", "yaw"};

/// The sine of the angle below which a second direction counts as parallel to the axis.
inline constexpr double parallel_slack = 1e-6;

/// Unit quaternions within this are normalised, or accepted; others are mistakes of the author.
inline constexpr double norm_slack = 1e-6;

/// Whether v has unit length to rounding: it is then kept, so that scene_text() is read back bit by
/// bit.
template <class V>
bool is_unit(const V& v) {
  constexpr double rounding = 1e-14;
  return std::abs(v.squaredNorm() - 1) <= rounding;
}

}  // namespace momenta::reading
