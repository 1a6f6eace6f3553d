// [[body]], [[joint]], [[loop]], [[marker]], [run]: the mechanism itself.

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {
namespace {

Shape read_shape(const Fields& table) {
  Shape shape;
  shape.kind = shape_kinds.at(read_kind(table, shape_kinds));
  constexpr Quantity extent{"m", Bound::positive};
  if (shape.kind == "rod") {
    table.allow({"kind", "length", "axis"});
    shape.size.x() = table.number("length", extent);
  } else if (shape.kind == "box") {
    table.allow({"kind", "size"});
    shape.size = table.vector("size", extent);
  } else if (shape.kind == "cylinder") {
    table.allow({"kind", "length", "radius", "axis"});
    shape.size = {table.number("length", extent), table.number("radius", extent), 0};
  } else if (shape.kind == "sphere") {
    table.allow({"kind", "radius"});
    shape.size.x() = table.number("radius", extent);
  } else {
    table.allow({"kind"});
  }
  shape.axis = table.direction("axis", shape.axis);
  return shape;
}

/// inertia = [xx, yy, zz, xy, xz, yz] | [xx, yy, zz] | Izz of a planar body
Eigen::Matrix3d read_inertia(const Fields& table) {
  constexpr Quantity moment{"kg m²"};
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  if (const Value* value = table.find("inertia"); value->type != Value::Type::array) {
    if (!is_number(*value) && value->type != Value::Type::text)
      table.fail_key("inertia",
                     "is " + std::string(described(value->type)) +
                         ", expected xx, yy, zz, xy, xz, yz in an array, or one number [kg m²]");
    const double izz = table.number("inertia", {"kg m²", Bound::not_negative});
    inertia.diagonal() << izz / 2, izz / 2, izz;
    return inertia;
  }
  const std::vector<double> m = table.numbers("inertia", moment);
  if (m.size() != 3 && m.size() != 6)
    table.fail_key(
        "inertia",
        "has " + std::to_string(m.size()) +
            " entries, expected 6 (xx, yy, zz, xy, xz, yz), 3 (xx, yy, zz) or one number [kg m²]");
  inertia.diagonal() << m[0], m[1], m[2];
  if (m.size() == 6) {
    inertia(0, 1) = inertia(1, 0) = m[3];
    inertia(0, 2) = inertia(2, 0) = m[4];
    inertia(1, 2) = inertia(2, 1) = m[5];
  }
  return inertia;
}

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

/// The last four of a position are a quaternion: normalised here when nearly so, so that no solver
/// meets a scaled one.
void normalise_quaternion(const Fields& table, std::vector<double>& position) {
  if (position.size() < 4) return;
  Eigen::Map<Eigen::Vector4d> quaternion(position.data() + position.size() - 4);
  const double norm = quaternion.norm();
  if (!(std::abs(norm - 1) <= norm_slack))
    table.fail_key("position",
                   "has a quaternion of norm " + digits(norm) + ", expected 1 within 1e-6");
  if (!is_unit(quaternion)) quaternion /= norm;
}

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

}  // namespace

BodySpec read_body(const Fields& table) {
  table.allow({"name", "mass", "com", "inertia", "any_inertia", "shape"});
  BodySpec body;
  body.at = table.at();
  body.name = table.text("name");
  body.mass = table.number("mass", {"kg", Bound::not_negative});

  if (const auto shape = table.table("shape")) {
    body.shape = read_shape(*shape);
  } else if (body.mass > 0 && !table.has("inertia")) {
    table.fail_at(
        table.at(),
        "a mass with neither shape nor inertia, expected one of them (a point mass is shape = { "
        "kind = \"point\" })");
  }

  // what is written out wins over the shape
  body.com = table.vector("com", {"m"}, centre_of(body.shape));
  body.inertia = table.has("inertia") ? read_inertia(table) : inertia_of(body.shape, body.mass);
  body.any_inertia = table.flag("any_inertia", false);
  if (const std::string fault = inertia_fault(body.inertia); !fault.empty() && !body.any_inertia)
    table.fail_key(table.has("inertia") ? "inertia" : "shape", fault);
  return body;
}

namespace {

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

void read_sum(const Fields& table, std::vector<std::string>& joints, std::vector<int>& coordinates,
              std::vector<double>& ratios) {
  joints = table.texts("joints");
  if (joints.empty()) table.fail_key("joints", "names no joint, expected at least one");
  ratios = table.numbers("ratios", {});
  if (table.has("coordinates"))
    for (const double x : table.numbers("coordinates", {})) {
      const int coordinate = x >= 0 && x < 10 ? static_cast<int>(x) : -1;
      if (coordinate != x)
        table.fail_key("coordinates",
                       "has " + digits(x) + ", expected whole numbers >= 0, one for each joint");
      coordinates.push_back(coordinate);
    }
}

namespace {

/// The keys of a coupler, which ties coordinates and no bodies.
void read_coupler(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "joints", "coordinates", "ratios", "powers", "offset"});
  loop.name = table.text("name");
  read_sum(table, loop.joints, loop.coordinates, loop.ratios);
  if (table.has("powers")) {
    loop.powers = table.numbers("powers", {});
    if (loop.powers.size() > 3)
      table.fail_key("powers", "has " + std::to_string(loop.powers.size()) +
                                   " entries, expected at most 3: of the second to fourth power "
                                   "of the last joint's coordinate");
  }
  loop.offset = table.number("offset", {"rad or m"}, 0);
}

/// "left = right" as left − right. Names in quotes may have any characters.
std::string as_difference(const Fields& table, const std::string& text) {
  std::size_t sign = std::string::npos;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (quoted || text[i] != '=') continue;
    if (i > 0 && text[i - 1] == ':')
      table.fail_key("equation",
                     "has ':=' in it, which equations do not take, expected them whole");
    const bool compares =
        (i > 0 && std::string_view("=<>!").find(text[i - 1]) != std::string::npos) ||
        (i + 1 < text.size() && text[i + 1] == '=');
    if (compares) continue;
    if (sign != std::string::npos)
      table.fail_key("equation", "has two '=', expected one, or a formula that is to be zero");
    sign = i;
  }
  if (sign == std::string::npos) return text;
  const auto blank = [](std::string_view side) {
    return side.find_first_not_of(" \t\n") == std::string_view::npos;
  };
  if (blank(std::string_view(text).substr(0, sign)) ||
      blank(std::string_view(text).substr(sign + 1)))
    table.fail_key("equation", "has nothing on one side of '=', expected a formula on either");
  return "(" + text.substr(0, sign) + ") - (" + text.substr(sign + 1) + ")";
}

/// The keys of an equation, of positions or of velocities; its names are looked up once the whole
/// scene is known.
void read_equation(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "equation"});
  loop.name = table.text("name");
  loop.equation = as_difference(table, table.text("equation"));
  if (loop.equation.empty())
    table.fail_key("equation", "is empty, expected a formula that is to be zero");
}

}  // namespace

LoopSpec read_loop(const Fields& table, std::span<const DriveSpec> drives) {
  LoopSpec loop;
  loop.at = table.at();
  loop.kind = static_cast<LoopKind>(read_kind(table, loop_kinds, "kind", joint_kinds, "[[joint]]"));
  const std::string kind(name_of(loop.kind));
  if (loop.kind == LoopKind::coupler) {
    read_coupler(table, loop);
    return loop;
  }
  if (has_equation(loop)) {
    read_equation(table, loop);
    return loop;
  }
  for (const std::string_view key : {"position", "velocity", "stiffness", "rest", "damping"})
    table.refuse(key,
                 "belongs to a [[joint]], expected none on a loop (a loop has no coordinates)");
  if (loop.kind == LoopKind::slot || loop.kind == LoopKind::cam || loop.kind == LoopKind::rack) {
    (loop.kind == LoopKind::slot  ? read_slot
     : loop.kind == LoopKind::cam ? read_cam
                                  : read_rack)(table, loop);
    return loop;
  }
  if (loop.kind == LoopKind::rolling) {
    read_rolling(table, loop);
    return loop;
  }
  for (const std::string_view key : {"joints", "coordinates", "ratios", "powers", "offset"})
    table.refuse(key, "has no meaning for a " + kind + " loop, expected on coupler only");
  if (!has_axis(loop.kind))
    table.refuse("axis", "has no meaning for a " + kind +
                             " loop, expected on revolute, prismatic, "
                             "universal, cylindrical and planar only");
  if (loop.kind != LoopKind::universal)
    table.refuse("axis2", "has no meaning for a " + kind + " loop, expected on universal only");
  if (loop.kind != LoopKind::planar)
    table.refuse("direction", "has no meaning for a " + kind + " loop, expected on planar only");
  if (loop.kind != LoopKind::distance)
    table.refuse("length", "has no meaning for a " + kind + " loop, expected on distance only");
  table.allow({"name", "kind", "parent", "child", "origin", "rotation", "axis", "axis2",
               "direction", "length"});

  loop.name = table.text("name");
  read_ends(table, loop);
  read_axes(table, loop);
  const auto prescribes_length = [&](const DriveSpec& drive) {
    return drive.loop == loop.name && drive.origin.empty();
  };
  if (loop.kind == LoopKind::distance &&
      (table.has("length") || std::none_of(drives.begin(), drives.end(), prescribes_length)))
    loop.length = table.number("length", {"m", Bound::positive});
  return loop;
}

MarkerSpec read_marker(const Fields& table) {
  table.allow({"name", "body", "point"});
  MarkerSpec marker;
  marker.at = table.at();
  marker.name = table.text("name");
  marker.body = table.text("body");
  marker.point = table.vector("point", {"m"}, marker.point);
  return marker;
}

EventSpec read_event(const Fields& table) {
  table.allow({"name", "when", "direction", "stop"});
  EventSpec event;
  event.at = table.at();
  event.name = table.text("name", "");
  if (table.has("name") && event.name.empty())
    table.fail_key("name", "is empty, expected a name or no such key");
  event.when.text = table.text("when");
  event.when.at = table.find("when")->at;
  if (table.has("direction"))
    event.direction = event_directions[read_kind(table, event_directions, "direction")];
  event.stop = table.flag("stop", false);
  return event;
}

RunDefaults read_run(const Fields& table) {
  table.allow({"end", "step", "leak", "samples", "project"});
  RunDefaults run;
  run.end_time = table.number("end", {"s", Bound::positive}, run.end_time);
  if (table.has("step")) run.step = table.number("step", {"s", Bound::positive});
  if (table.has("leak")) run.leak = table.number("leak", {"1/s", Bound::positive});
  run.samples = table.count("samples", run.samples);
  run.project = table.flag("project", run.project);
  return run;
}

}  // namespace momenta::reading
