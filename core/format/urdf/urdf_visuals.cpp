// <visual> and <collision> of links as drawn solids.

#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/format/xml/file_inside.h>

#include <optional>

namespace momenta::reading {
namespace {

std::optional<Eigen::Vector3d> colour_in(const Node& material) {
  const auto colour = material.child("color");
  if (!colour) return std::nullopt;
  const std::vector<double> rgba = colour->numbers("rgba", 4);
  return Eigen::Vector3d(rgba[0], rgba[1], rgba[2]).cwiseMax(0).cwiseMin(1);
}

/// Takes a mesh with an existing file of a known kind; else false, with the reason as a plural.
bool take_mesh(const Node& mesh, const std::string& file, VisualSpec& visual, std::string& why) {
  visual.kind = "mesh";
  visual.size = mesh.vector("scale", Eigen::Vector3d::Ones());
  const std::string name = mesh.text("filename");
  visual.file = mesh_path(name, file);
  if (visual.file.empty())
    why = "meshes to draw whose files are not there";
  else if (!is_mesh_file(visual.file))
    why = "meshes to draw that are no STL, OBJ or MSH";
  return why.empty();
}

/// The solid of a <visual> or <collision>; none: the reason is in `why`.
std::optional<VisualSpec> solid_of(const Node& part, const LinkDrawing& drawing, std::string& why) {
  why.clear();
  const auto geometry = part.child("geometry");
  VisualSpec visual;
  visual.body = drawing.body;
  visual.at = part.at();
  Eigen::Index sizes = 3;
  if (!geometry) {
    why = "visual shapes without a geometry";
    return std::nullopt;
  }
  if (const auto box = geometry->child("box")) {
    visual.kind = "box";
    visual.size = box->vector("size");
  } else if (const auto sphere = geometry->child("sphere")) {
    visual.kind = "sphere";
    visual.size[0] = sphere->number("radius");
    sizes = 1;
  } else if (const auto mesh = geometry->child("mesh")) {
    if (!take_mesh(*mesh, drawing.file, visual, why)) return std::nullopt;
    sizes = 0;
  } else {
    for (const char* kind : {"cylinder", "capsule"})
      if (const auto round = geometry->child(kind)) {
        visual.kind = kind;
        visual.size = {round->number("length"), round->number("radius"), 0};
        sizes = 2;
      }
  }
  if (visual.kind.empty() || (sizes > 0 && !(visual.size.head(sizes).minCoeff() > 0))) {
    why = "visual shapes of no known kind or without a size";
    return std::nullopt;
  }
  const Origin origin = read_origin(part);
  visual.position = origin.xyz;
  visual.rotation = origin.turn;
  if (const auto material = part.child("material")) {
    visual.colour = colour_in(*material);
    const auto known = drawing.materials.find(material->text("name", ""));
    if (!visual.colour && known != drawing.materials.end()) visual.colour = known->second;
  }
  return visual;
}

}  // namespace

std::map<std::string, Eigen::Vector3d> colours_of(const Node& robot, Remarks& remarks) {
  std::map<std::string, Eigen::Vector3d> colours;
  const auto take = [&](const Node& material) {
    try {
      if (const auto colour = colour_in(material); colour && !material.text("name", "").empty())
        colours.emplace(material.text("name"), *colour);
    } catch (const SceneError& error) {
      remarks.not_drawn(error);
    }
  };
  for (const Node& material : robot.children("material")) take(material);
  // Later links may name a link's material.
  for (const Node& link : robot.children("link"))
    for (const Node& visual : link.children("visual"))
      for (const Node& material : visual.children("material")) take(material);
  return colours;
}

void draw_link(const Node& link, const LinkDrawing& drawing, std::vector<VisualSpec>& visuals,
               Remarks& remarks) {
  const std::size_t before = visuals.size();
  const auto draw = [&](const char* kind, bool tells_why) {
    for (const Node& part : link.children(kind)) try {
        std::string why;
        if (auto solid = solid_of(part, drawing, why))
          visuals.push_back(std::move(*solid));
        else if (tells_why)
          remarks.left_out(why);
      } catch (const SceneError& error) {
        remarks.not_drawn(error);
      }
  };
  draw("visual", true);
  if (visuals.size() == before) draw("collision", false);
}

}  // namespace momenta::reading
