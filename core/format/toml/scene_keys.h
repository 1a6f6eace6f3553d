#pragma once
// Declarations of the tables of the scene format (keys.h), one function each. The kind of a joint,
// a loop, a drive, a force or a visual is known before its keys. The checks here are of one table;
// validate() checks what concerns several.

#include <momenta/core/format/toml/keys.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/scene.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

void declare(Keys& t, BodySpec& body);
void declare(Keys& t, JointSpec& joint);
/// `drives`: drives of the scene, which may replace numbers of the loop.
void declare(Keys& t, LoopSpec& loop, std::span<const DriveSpec> drives);
void declare(Keys& t, DriveSpec& drive);
void declare(Keys& t, ForceSpec& force);
void declare(Keys& t, FunctionSpec& function);
void declare(Keys& t, MarkerSpec& marker);
void declare(Keys& t, EventSpec& event);
void declare(Keys& t, VisualSpec& visual);
void declare(Keys& t, RunDefaults& run);
void declare(Keys& t, LagrangianSpec& spec);
void declare(Keys& t, LagrangianSpec::Constraint& constraint);

// Kinds, read ahead of the other keys.
void read_kind_of(const Fields& table, JointSpec& joint);
void read_kind_of(const Fields& table, LoopSpec& loop);
void read_kind_of(const Fields& table, DriveSpec& drive);
void read_kind_of(const Fields& table, ForceSpec& force);
void read_kind_of(const Fields& table, VisualSpec& visual);

/// Points of a function from the columns `x` and `y` of its `file`.
void read_columns(const Fields& table, FunctionSpec& function);

/// Checks formulas of forces, drives and events, kept as text so far, and puts numbers in place of
/// parameters. `root`: the scene's table. @pre parameters, joints, markers and forces of the scene
/// are read
void read_formulas(const Fields& root, Scene& scene);

// Keys shared by joints, loops and forces.

/// Joints, coordinates and ratios of a coupler or a coordinate spring. Keys after them are written
/// from place 1 on.
void declare_sum(Keys& t, std::vector<std::string>& joints, std::vector<int>& coordinates,
                 std::vector<double>& ratios);

/// Bodies and points of a joint, of a loop or force between two bodies: origin = { parent = [..],
/// child = [..] }.
template <class Spec>
void declare_ends(Keys& t, Spec& spec) {
  t.value_or("parent", spec.parent, "ground");
  t.value("child", spec.child);
  t.table("origin", [&](Keys& origin) {
    origin.vector("parent", spec.origin_parent, {"m"});
    origin.vector("child", spec.origin_child, {"m"});
  });
}

/// A second axis or direction of a joint or a loop; zero: the default.
template <class Spec>
void declare_second(Keys& t, std::string_view key, Eigen::Vector3d& second, const Spec& spec) {
  t.direction(key, second, Eigen::Vector3d::Zero());
  if (t.reads() && t.in().has(key) && spec.axis.cross(second).norm() < parallel_slack)
    t.in().fail_key(key, "is parallel to axis, expected another direction");
}

/// Limits = [least, largest] of a joint or of a force along a length, in `unit`, and stops, which
/// push back by `force`.
template <class Spec>
void declare_limits(Keys& t, const std::string& unit, const std::string& force, Spec& spec) {
  std::vector<double> limits;
  if (spec.limits) limits.assign(spec.limits->begin(), spec.limits->end());
  t.optional("limits", limits, {unit});
  if (t.reads() && t.in().has("limits")) {
    if (limits.size() != 2 || !(limits[0] < limits[1]))
      t.in().fail_key("limits", limits.size() == 2
                                    ? "has its first number not below its second, expected it below"
                                    : "has " + std::to_string(limits.size()) +
                                          " entries, expected the least and the "
                                          "largest coordinate");
    spec.limits = {limits[0], limits[1]};
  }
  if (t.reads() && !spec.limits)
    for (const char* key : {"stop_stiffness", "stop_damping", "stop_width"})
      t.in().refuse(key, "is there without limits, expected limits to stop at");
  const std::string spring = force + "/" + unit, damper = force + " s/" + unit;
  t.number("stop_stiffness", spec.stop_stiffness, {spring, Bound::not_negative});
  t.number("stop_damping", spec.stop_damping, {damper, Bound::not_negative});
  t.number("stop_width", spec.stop_width, {unit, Bound::positive}, Spec{}.stop_width);
}

}  // namespace momenta::reading
