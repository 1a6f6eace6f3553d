#pragma once
// One function per table of the scene format. Each checks keys, types and values by themselves;
// validate() checks what concerns several tables.

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/toml/fields.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace momenta::reading {

BodySpec read_body(const Fields& table);
JointSpec read_joint(const Fields& table);
/// `drives`: drives of the scene, which may replace numbers of the loop.
LoopSpec read_loop(const Fields& table, std::span<const DriveSpec> drives);
/// Keys of slots, cams, racks and rolling loops beside their kind.
void read_slot(const Fields& table, LoopSpec& loop);
void read_cam(const Fields& table, LoopSpec& loop);
void read_rack(const Fields& table, LoopSpec& loop);
void read_rolling(const Fields& table, LoopSpec& loop);
DriveSpec read_drive(const Fields& table);
ForceSpec read_force(const Fields& table);
FunctionSpec read_function(const Fields& table);
/// Points of a function from the columns `x` and `y` of its `file`.
void read_columns(const Fields& table, FunctionSpec& function);
MarkerSpec read_marker(const Fields& table);
EventSpec read_event(const Fields& table);
VisualSpec read_visual(const Fields& table);
RunDefaults read_run(const Fields& table);
LagrangianSpec read_lagrangian(const Fields& table);

/// Checks formulas of forces, drives and events, kept as text so far, and puts numbers in place of
/// parameters. `root`: the scene's table. @pre parameters, joints, markers and forces of the scene
/// are read
void read_formulas(const Fields& root, Scene& scene);

/// The index in `kinds` of the value of `key`; else fails with the kinds there are. `others`: kinds
/// of another table, which the sentence then names.
std::size_t read_kind(const Fields& table, std::span<const std::string_view> kinds,
                      std::string_view key, std::span<const std::string_view> others = {},
                      std::string_view table_of_others = {});
/// The same for the key `kind`.
inline std::size_t read_kind(const Fields& table, std::span<const std::string_view> kinds) {
  return read_kind(table, kinds, "kind");
}

/// Reads joints, coordinates and ratios of a coupler or a coordinate spring.
void read_sum(const Fields& table, std::vector<std::string>& joints, std::vector<int>& coordinates,
              std::vector<double>& ratios);

/// Reads limits = [least, largest] of a joint or of a force along a length, in `unit`, and stops,
/// which push back by `force`.
template <class Spec>
void read_limits(const Fields& table, const std::string& unit, const std::string& force,
                 Spec& spec) {
  if (table.has("limits")) {
    const std::vector<double> limits = table.numbers("limits", {unit});
    if (limits.size() != 2 || !(limits[0] < limits[1]))
      table.fail_key("limits", limits.size() == 2
                                   ? "has its first number not below its second, expected it below"
                                   : "has " + std::to_string(limits.size()) +
                                         " entries, expected the least and the "
                                         "largest coordinate");
    spec.limits = {limits[0], limits[1]};
  }
  for (const char* key : {"stop_stiffness", "stop_damping", "stop_width"})
    if (!spec.limits) table.refuse(key, "is there without limits, expected limits to stop at");
  const std::string spring = force + "/" + unit, damper = force + " s/" + unit;
  spec.stop_stiffness = table.number("stop_stiffness", {spring, Bound::not_negative}, 0);
  spec.stop_damping = table.number("stop_damping", {damper, Bound::not_negative}, 0);
  spec.stop_width = table.number("stop_width", {unit, Bound::positive}, spec.stop_width);
}

/// origin = { parent = [..], child = [..] }, both zero by default.
struct Origins {
  Eigen::Vector3d parent = Eigen::Vector3d::Zero();
  Eigen::Vector3d child = Eigen::Vector3d::Zero();
};
Origins read_origins(const Fields& table);

/// Reads bodies and points of a joint, of a loop or force between two bodies.
template <class Spec>
void read_ends(const Fields& table, Spec& spec) {
  spec.parent = table.text("parent", spec.parent);
  spec.child = table.text("child");
  const Origins origins = read_origins(table);
  spec.origin_parent = origins.parent;
  spec.origin_child = origins.child;
}

/// rotation = { rpy = [roll, pitch, yaw] } | { quaternion = [w, x, y, z] } | { axis = .., angle =
/// .. }; rpy means Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Quaterniond read_rotation(const Fields& table);

/// Reads rotation and axes of the frame of a joint or a loop.
template <class Spec>
void read_axes(const Fields& table, Spec& spec) {
  spec.rotation = read_rotation(table);
  spec.axis = table.direction("axis", spec.axis);
  spec.axis2 = table.direction("axis2", spec.axis2);
  spec.direction = table.direction("direction", spec.direction);
  for (const char* key : {"axis2", "direction"})
    if (table.has(key) && spec.axis.cross(table.direction(key, {})).norm() < parallel_slack)
      table.fail_key(key, "is parallel to axis, expected another direction");
}

}  // namespace momenta::reading
