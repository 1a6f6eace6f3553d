// <visual> and <collision> of links as solids to be drawn.

#include <momenta/core/scene/urdf/urdf.h>

#include <optional>

namespace momenta::reading {
namespace {

/// The solid of a <visual> or <collision>; none: a mesh, or one without a size.
std::optional<VisualSpec> solid_of(const Node& part, const std::string& body) {
  const auto geometry = part.child("geometry");
  if (!geometry) return std::nullopt;
  VisualSpec visual;
  visual.body = body;
  visual.at = part.at();
  Eigen::Index sizes = 3;
  if (const auto box = geometry->child("box")) {
    visual.kind = "box";
    visual.size = box->vector("size");
  } else if (const auto sphere = geometry->child("sphere")) {
    visual.kind = "sphere";
    visual.size[0] = sphere->number("radius");
    sizes = 1;
  } else {
    for (const char* kind : {"cylinder", "capsule"})
      if (const auto round = geometry->child(kind)) {
        visual.kind = kind;
        visual.size = {round->number("length"), round->number("radius"), 0};
        sizes = 2;
      }
    if (visual.kind.empty()) return std::nullopt;
  }
  if (!(visual.size.head(sizes).minCoeff() > 0)) return std::nullopt;
  const Origin origin = read_origin(part);
  visual.position = origin.xyz;
  visual.rotation = origin.turn;
  if (const auto material = part.child("material"))
    if (const auto colour = material->child("color")) {
      const std::vector<double> rgba = colour->numbers("rgba", 4);
      visual.colour = Eigen::Vector3d(rgba[0], rgba[1], rgba[2]).cwiseMax(0).cwiseMin(1);
    }
  return visual;
}

}  // namespace

void draw_link(const Node& link, std::vector<VisualSpec>& visuals, Remarks& remarks) {
  const std::string body = link.text("name");
  const std::size_t before = visuals.size();
  for (const Node& part : link.children("visual")) {
    if (auto solid = solid_of(part, body))
      visuals.push_back(std::move(*solid));
    else
      remarks.left_out("visual shapes");
  }
  if (visuals.size() > before) return;
  for (const Node& part : link.children("collision"))
    if (auto solid = solid_of(part, body)) visuals.push_back(std::move(*solid));
}

}  // namespace momenta::reading
