#include <momenta/core/format/mjcf/mjcf_inertia.h>
#include <momenta/core/format/mjcf/mjcf_visuals.h>

#include <optional>
#include <set>

namespace momenta::reading {
namespace {

using Eigen::Vector3d;

/// Red, green, blue of `rgba`, clamped to 0 … 1; none: not given.
std::optional<Vector3d> colour_of(const Node& node) {
  if (!node.has("rgba")) return std::nullopt;
  const std::vector<double> rgba = node.numbers("rgba", 4);
  return Vector3d(rgba[0], rgba[1], rgba[2]).cwiseMax(0).cwiseMin(1);
}

}  // namespace

void read_materials(const Node& asset, MjcfModel& model) {
  for (const Node& part : asset.children("material")) try {
      const Element full = model.defaults.with_defaults(part, "material", MjcfDefaults::main_class);
      const Node material(full, part.owner(), model.scene.file);
      if (const auto colour = colour_of(material); colour && material.has("name"))
        model.materials.emplace(material.text("name"), *colour);
    } catch (const SceneError& error) {
      model.remarks.not_drawn(error);
    }
}

namespace {

void read_drawn(const MjcfPart& part, const std::string& body, MjcfModel& model) {
  const Element full = model.defaults.with_defaults(part.node, "geom", part.active);
  const Node geom(full, part.node.owner(), model.scene.file);
  const auto shape = static_cast<GeomShape>(geom.word("type", geom_shapes, 0));
  if (shape == GeomShape::plane || shape == GeomShape::hfield || shape == GeomShape::sdf ||
      (geom.has("mesh") && shape != GeomShape::mesh))
    return;
  VisualSpec visual;
  const MjcfFrame frame = part.in * read_frame(geom, model.angles);
  if (shape == GeomShape::mesh) {
    std::string why;
    const auto mesh = model.meshes.drawn(geom, frame, model.folder, why);
    if (!mesh) return model.remarks.left_out(why);
    visual = *mesh;
  } else {
    const Vector3d s = geom_size(geom, shape);
    visual.kind = geom_shapes[static_cast<std::size_t>(shape)];
    if (shape == GeomShape::box)
      visual.size = 2 * s;
    else if (shape == GeomShape::capsule || shape == GeomShape::cylinder)
      visual.size = {2 * s[1], s[0], 0};
    else
      visual.size = s;
    visual.position = frame.at;
    visual.rotation = frame.turn.normalized();
  }
  visual.at = geom.at();
  visual.body = body;
  visual.colour = colour_of(geom);
  if (const auto known = model.materials.find(geom.text("material", ""));
      !visual.colour && known != model.materials.end())
    visual.colour = known->second;
  const bool unseen = geom.has("rgba") && geom.numbers("rgba", 4)[3] == 0;
  model.drawn.emplace_back(std::move(visual), geom.number("group", 0) <= 2 && !unseen);
}

}  // namespace

void draw_geom(const MjcfPart& part, const std::string& body, MjcfModel& model) try {
  model.remarks.left_out("geoms as shapes to touch");
  read_drawn(part, body, model);
} catch (const SceneError& error) {
  model.remarks.not_drawn(error);
}

void take_drawn(MjcfModel& model) {
  std::set<std::string> seen;
  for (const auto& [visual, shown] : model.drawn)
    if (shown) seen.insert(visual.body);
  for (auto& [visual, shown] : model.drawn)
    if (shown || (!seen.contains(visual.body) && visual.body != "ground"))
      model.scene.visuals.push_back(std::move(visual));
}

}  // namespace momenta::reading
