// [[joint]].

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {
namespace {

/// position, velocity: one number for one degree of freedom, else an array.
std::vector<double> read_state(const Fields& table, std::string_view key, std::size_t size,
                               const std::string& kind, Quantity quantity) {
  const Value* value = table.find(key);
  if (value == nullptr) return {};
  if (size == 1 && value->type != Value::Type::array) return {table.number(key, quantity)};
  std::vector<double> state = table.numbers(key, size == 1 ? quantity : Quantity{});
  if (state.size() != size)
    table.fail_key(key, "has " + std::to_string(state.size()) + " entries, expected " +
                            std::to_string(size) + " for a " + kind + " joint");
  return state;
}

/// Normalises the quaternion, the last four numbers of a position, when nearly of unit length, so
/// that no solver meets a scaled one.
void normalise_quaternion(const Fields& table, std::vector<double>& position) {
  if (position.size() < 4) return;
  Eigen::Map<Eigen::Vector4d> quaternion(position.data() + position.size() - 4);
  const double norm = quaternion.norm();
  if (!(std::abs(norm - 1) <= norm_slack))
    table.fail_key("position",
                   "has a quaternion of norm " + digits(norm) + ", expected 1 within 1e-6");
  if (!is_unit(quaternion)) quaternion /= norm;
}

BearingSpec read_bearing(const Fields& table, bool turns) {
  table.allow({"static", "dynamic", "transition", "radius", "length"});
  if (!turns)
    table.refuse("radius", "has no meaning for a prismatic joint, expected on revolute only");
  BearingSpec bearing;
  bearing.dynamic_friction = table.number("dynamic", {"", Bound::not_negative});
  bearing.static_friction = table.number("static", {""}, bearing.dynamic_friction);
  if (bearing.static_friction < bearing.dynamic_friction)
    table.fail_key("static",
                   "is " + digits(bearing.static_friction) +
                       ", below dynamic, expected a number >= " + digits(bearing.dynamic_friction));
  bearing.transition_velocity =
      table.number("transition", {"m/s", Bound::positive}, bearing.transition_velocity);
  if (turns) bearing.radius = table.number("radius", {"m", Bound::positive});
  if (table.has("length")) bearing.length = table.number("length", {"m", Bound::positive});
  return bearing;
}

}  // namespace

JointSpec read_joint(const Fields& table) {
  JointSpec joint;
  joint.at = table.at();
  joint.kind =
      static_cast<JointKind>(read_kind(table, joint_kinds, "kind", loop_kinds, "[[loop]]"));
  const std::string kind(name_of(joint.kind));
  if (!has_axis(joint.kind))
    table.refuse("axis", "has no meaning for a " + kind +
                             " joint, expected on revolute, prismatic, helical, cylindrical, "
                             "universal and planar only");
  if (!has_one_coordinate(joint.kind))
    for (const std::string_view key : {"stiffness", "rest", "damping", "friction", "friction_rate"})
      table.refuse(key, "has no meaning for a " + kind +
                            " joint, expected on revolute, prismatic and helical only");
  if (!has_one_coordinate(joint.kind) && joint.kind != JointKind::spherical)
    for (const std::string_view key :
         {"limits", "stop_stiffness", "stop_damping", "stop_width", "restitution"})
      table.refuse(key, "has no meaning for a " + kind +
                            " joint, expected on revolute, prismatic, helical and spherical only");
  if (joint.kind == JointKind::spherical)
    table.refuse("restitution",
                 "has no meaning for a spherical joint, expected on revolute, "
                 "prismatic and helical only");
  if (joint.kind != JointKind::revolute && joint.kind != JointKind::prismatic)
    table.refuse("bearing", "has no meaning for a " + kind +
                                " joint, expected on revolute and prismatic only");
  const auto only = [&](std::string_view key, JointKind owner) {
    if (joint.kind != owner)
      table.refuse(key, "has no meaning for a " + kind + " joint, expected on " +
                            std::string(name_of(owner)) + " only");
  };
  only("pitch", JointKind::helical);
  only("axis2", JointKind::universal);
  only("direction", JointKind::planar);
  if (rotors_of(joint.kind) == 0)
    table.refuse("rotor_inertia",
                 "has no meaning for a " + kind +
                     " joint, expected on revolute, prismatic, helical, cylindrical, "
                     "universal, planar and spherical joints only");
  table.refuse("length", "belongs to a [[loop]] of kind distance, expected none on a joint");
  table.allow({"name",         "kind",          "parent",        "child",     "origin",
               "rotation",     "axis",          "axis2",         "direction", "pitch",
               "position",     "velocity",      "stiffness",     "rest",      "damping",
               "friction",     "friction_rate", "rotor_inertia", "limits",    "stop_stiffness",
               "stop_damping", "stop_width",    "restitution",   "bearing"});

  joint.name = table.text("name");
  read_ends(table, joint);
  read_axes(table, joint);
  if (joint.kind == JointKind::helical) joint.pitch = table.number("pitch", {"m/rad"});

  const bool turns = joint.kind != JointKind::prismatic;
  joint.position =
      read_state(table, "position", static_cast<std::size_t>(coordinates_of(joint.kind)), kind,
                 {turns ? "rad" : "m"});
  joint.velocity = read_state(table, "velocity", static_cast<std::size_t>(rates_of(joint.kind)),
                              kind, {turns ? "rad/s" : "m/s"});
  normalise_quaternion(table, joint.position);

  joint.stiffness = table.number("stiffness", {turns ? "N m/rad" : "N/m"}, 0);
  joint.rest = table.number("rest", {turns ? "rad" : "m"}, 0);
  joint.damping = table.number("damping", {turns ? "N m s/rad" : "N s/m"}, 0);
  joint.friction = table.number("friction", {turns ? "N m" : "N", Bound::not_negative}, 0);
  joint.friction_rate = table.number("friction_rate", {turns ? "rad/s" : "m/s", Bound::positive},
                                     joint.friction_rate);
  if (const auto bearing = table.table("bearing")) joint.bearing = read_bearing(*bearing, turns);
  read_limits(table, turns ? "rad" : "m", turns ? "N m" : "N", joint);
  if (table.has("restitution")) {
    if (!joint.limits)
      table.refuse("restitution", "is there without limits, expected limits to stop at");
    for (const char* key : {"stop_stiffness", "stop_damping", "stop_width"})
      table.refuse(key, "is given beside restitution, expected stops that give way or rigid ones");
    joint.restitution = table.number("restitution", {"", Bound::not_negative});
    if (*joint.restitution > 1)
      table.fail_key("restitution",
                     "is above 1, expected the rate after an impact over that before, 0 to 1");
  }
  joint.rotor_inertia = read_state(table, "rotor_inertia", rotors_of(joint.kind), kind,
                                   {turns ? "kg m²" : "kg", Bound::not_negative});
  return joint;
}

}  // namespace momenta::reading
