// [[visual]]: solids that are drawn.

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <vector>

namespace momenta::reading {

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
