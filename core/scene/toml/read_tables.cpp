// [[marker]], [[event]], [run].

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace momenta::reading {

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

// Keys shared by joints, loops and forces: kind, origin, rotation.

std::size_t read_kind(const Fields& table, std::span<const std::string_view> kinds,
                      std::string_view key, std::span<const std::string_view> others,
                      std::string_view table_of_others) {
  const std::string kind = table.text(key);
  const auto found = std::find(kinds.begin(), kinds.end(), kind);
  if (found != kinds.end()) return static_cast<std::size_t>(found - kinds.begin());

  std::string sentence = "is " + in_quotes(kind);
  if (std::find(others.begin(), others.end(), kind) != others.end())
    sentence += ", which only a " + std::string(table_of_others) + " can be";
  table.fail_key(key, sentence + ", expected one of: " + listed(kinds) + did_you_mean(kind, kinds));
}

Origins read_origins(const Fields& table) {
  Origins origins;
  if (const auto origin = table.table("origin")) {
    origin->allow({"parent", "child"});
    origins.parent = origin->vector("parent", {"m"}, origins.parent);
    origins.child = origin->vector("child", {"m"}, origins.child);
  }
  return origins;
}

Eigen::Quaterniond read_rotation(const Fields& table) {
  const auto rotation = table.table("rotation");
  if (!rotation) return Eigen::Quaterniond::Identity();
  rotation->allow({"rpy", "quaternion", "axis", "angle"});
  const int ways = rotation->has("rpy") + rotation->has("quaternion") +
                   (rotation->has("axis") || rotation->has("angle"));
  if (ways != 1)
    table.fail_key("rotation", "is given in " + std::to_string(ways) +
                                   " ways, expected one of: rpy, quaternion, axis with angle");

  using Turn = Eigen::AngleAxisd;
  if (rotation->has("rpy")) {
    const Eigen::Vector3d rpy = rotation->vector("rpy", {"rad"});
    return Turn(rpy[2], Eigen::Vector3d::UnitZ()) * Turn(rpy[1], Eigen::Vector3d::UnitY()) *
           Turn(rpy[0], Eigen::Vector3d::UnitX());
  }
  if (rotation->has("quaternion")) {
    const std::vector<double> wxyz = rotation->numbers("quaternion", {});
    if (wxyz.size() != 4)
      rotation->fail_key("quaternion",
                         "has " + std::to_string(wxyz.size()) + " entries, expected w, x, y, z");
    const Eigen::Quaterniond quaternion(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    const double norm = quaternion.norm();
    if (!(std::abs(norm - 1) <= norm_slack))
      rotation->fail_key("quaternion", "has the norm " + digits(norm) + ", expected 1 within 1e-6");
    return is_unit(quaternion) ? quaternion : quaternion.normalized();
  }
  const double angle = rotation->number("angle", {"rad"});
  if (!rotation->has("axis")) table.fail_key("rotation", "has an angle and no axis, expected both");
  return Eigen::Quaterniond(Turn(angle, rotation->direction("axis", Eigen::Vector3d::UnitZ())));
}

// [[visual]]: solids that are drawn.

VisualSpec read_visual(const Fields& table) {
  VisualSpec visual;
  visual.at = table.at();
  visual.kind = visual_kinds.at(read_kind(table, visual_kinds));
  constexpr Quantity extent{"m", Bound::positive};
  const auto allow = [&](std::vector<std::string_view> keys) {
    keys.insert(keys.end(), {"body", "kind", "position", "rotation", "colour"});
    table.allow(keys);
  };
  if (visual.kind == "box" || visual.kind == "ellipsoid") {
    allow({"size"});
    visual.size = table.vector("size", extent);
  } else if (visual.kind == "sphere") {
    allow({"radius"});
    visual.size.x() = table.number("radius", extent);
  } else if (visual.kind == "mesh") {
    allow({"file", "scale"});
    visual.file = table.text("file");
    if (visual.file.empty()) table.fail_key("file", "is empty, expected the path of a mesh");
    visual.size = table.vector("scale", {}, Eigen::Vector3d::Ones());
  } else {
    allow({"length", "radius"});
    visual.size = {table.number("length", extent), table.number("radius", extent), 0};
  }
  visual.body = table.text("body");
  visual.position = table.vector("position", {"m"}, visual.position);
  visual.rotation = read_rotation(table);
  if (table.has("colour")) {
    visual.colour = table.vector("colour", {});
    for (const double part : *visual.colour)
      if (!(part >= 0 && part <= 1))
        table.fail_key("colour", "has " + digits(part) + ", expected red, green, blue from 0 to 1");
  }
  return visual;
}

}  // namespace momenta::reading
