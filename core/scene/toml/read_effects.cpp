// [[drive]] and [[force]].

#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <initializer_list>
#include <string_view>
#include <vector>

namespace momenta::reading {
namespace {

/// A formula as text, read by read_formulas() once the whole scene is known.
std::string read_formula(const Fields& table, std::string_view key) {
  const std::string text = table.text(key);
  if (text.empty()) table.fail_key(key, "is empty, expected a formula");
  return text;
}

}  // namespace

DriveSpec read_drive(const Fields& table) {
  DriveSpec drive;
  drive.at = table.at();
  drive.kind = drive_kinds.at(read_kind(table, drive_kinds));

  // the unit of the driven number, rad or m, is not known here
  constexpr Quantity coordinate{};
  const auto allow = [&](std::vector<std::string_view> keys) {
    keys.insert(keys.end(), {"joint", "loop", "coordinate", "origin", "kind"});
    table.allow(keys);
  };
  if (drive.kind == "polynomial") {
    allow({"coefficients"});
    drive.coefficients = table.numbers("coefficients", coordinate);
  } else if (drive.kind == "harmonic") {
    allow({"offset", "amplitude", "frequency", "phase"});
    drive.offset = table.number("offset", coordinate, 0);
    drive.amplitude = table.number("amplitude", coordinate);
    drive.frequency = table.number("frequency", {"rad/s"});
    drive.phase = table.number("phase", {"rad"}, 0);
  } else if (drive.kind == "step") {
    allow({"from", "to", "start", "duration"});
    drive.from = table.number("from", coordinate, 0);
    drive.to = table.number("to", coordinate);
    drive.start = table.number("start", {"s"}, 0);
    drive.duration = table.number("duration", {"s", Bound::positive});
  } else if (drive.kind == "table") {
    allow({"times", "values"});
    drive.times = table.numbers("times", {"s"});
    drive.values = table.numbers("values", coordinate);
  } else {
    allow({"law"});
    drive.law = read_formula(table, "law");
  }
  if (table.has("joint") && table.has("loop"))
    table.fail_key("loop", "is given beside joint, expected one of them");
  drive.coordinate = table.index("coordinate", 0);
  if (!table.has("loop")) {
    table.refuse("origin", "belongs to the drive of a loop, expected none on that of a joint");
    drive.joint = table.text("joint");
  } else {
    drive.loop = table.text("loop");
    if (table.has("origin")) {
      drive.origin = table.text("origin");
      if (drive.origin != "x" && drive.origin != "y" && drive.origin != "z")
        table.fail_key("origin",
                       "is " + in_quotes(drive.origin) +
                           ", expected \"x\", \"y\" or \"z\" of the loop's origin.parent");
      table.refuse("coordinate", "is given beside origin, expected one of them");
    }
  }
  if (drive.kind == "formula") return drive;  // judged by read_formulas()
  if (const std::string fault = law_fault(drive); !fault.empty()) table.fail_at(table.at(), fault);
  return drive;
}

namespace {

/// The formula in `law`, without the keys that it replaces; empty: none.
std::string read_law(const Fields& table, std::initializer_list<std::string_view> instead_of) {
  if (!table.has("law")) return "";
  for (const std::string_view key : instead_of)
    table.refuse(key, "is given beside law, expected one of them");
  return read_formula(table, "law");
}

}  // namespace

ForceSpec read_force(const Fields& table) {
  ForceSpec force;
  force.at = table.at();
  force.kind = force_kinds.at(read_kind(table, force_kinds));
  if (force.kind == "spring-damper") {
    table.allow({"name", "kind", "parent", "child", "origin", "stiffness", "damping", "rest",
                 "dead_band", "limits", "stop_stiffness", "stop_damping", "stop_width", "law"});
    read_ends(table, force);
    force.law = read_law(table, {"stiffness", "damping", "rest", "dead_band", "limits"});
    force.stiffness = table.number("stiffness", {"N/m"}, 0);
    force.damping = table.number("damping", {"N s/m"}, 0);
    force.rest = table.number("rest", {"m", Bound::not_negative}, 0);
    force.dead_band = table.number("dead_band", {"m", Bound::not_negative}, 0);
    read_limits(table, "m", "N", force);
  } else if (force.kind == "bushing") {
    table.allow({"name", "kind", "parent", "child", "origin", "rotation", "stiffness", "damping",
                 "rotational_stiffness", "rotational_damping"});
    read_ends(table, force);
    force.rotation = read_rotation(table);
    force.stiffness = table.number("stiffness", {"N/m"}, 0);
    force.damping = table.number("damping", {"N s/m"}, 0);
    force.rotational_stiffness = table.number("rotational_stiffness", {"N m/rad"}, 0);
    force.rotational_damping = table.number("rotational_damping", {"N m s/rad"}, 0);
  } else if (force.kind == "coordinate-spring") {
    table.allow({"name", "kind", "joints", "coordinates", "ratios", "stiffness", "damping", "rest",
                 "dead_band", "limits", "stop_stiffness", "stop_damping", "stop_width", "law"});
    read_sum(table, force.joints, force.coordinates, force.ratios);
    force.law = read_law(table, {"stiffness", "damping", "rest", "dead_band", "limits"});
    force.stiffness = table.number("stiffness", {"N m/rad or N/m"}, 0);
    force.damping = table.number("damping", {"N m s/rad or N s/m"}, 0);
    force.rest = table.number("rest", {"rad or m"}, 0);
    force.dead_band = table.number("dead_band", {"rad or m", Bound::not_negative}, 0);
    read_limits(table, "rad or m", "N m or N", force);
  } else if (force.kind == "torque") {
    table.allow({"name", "kind", "joint", "value", "law"});
    force.joint = table.text("joint");
    force.law = read_law(table, {"value"});
    if (force.law.empty()) force.value = table.number("value", {"N m or N"});
  } else if (force.kind == "potential") {
    table.allow({"name", "kind", "V"});
    force.law = read_formula(table, "V");
  } else {
    table.allow({"name", "kind", "body", "point", "force", "torque", "axes"});
    force.body = table.text("body");
    force.point = table.vector("point", {"m"}, force.point);
    table.vector_or_formulas("force", {"N"}, force.force, force.force_law);
    table.vector_or_formulas("torque", {"N m"}, force.torque, force.torque_law);
    const std::string axes = table.text("axes", "ground");
    if (axes != "ground" && axes != "body")
      table.fail_key("axes", "is " + in_quotes(axes) + ", expected \"ground\" or \"body\"");
    force.in_body_axes = axes == "body";
  }
  if (table.has("name")) {
    force.name = table.text("name");
    if (force.name.empty()) table.fail_key("name", "is empty, expected a name or no such key");
  }
  return force;
}

}  // namespace momenta::reading
