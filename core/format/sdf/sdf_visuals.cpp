// <visual>s of links as drawn solids.

#include <momenta/core/format/sdf/sdf_model.h>
#include <momenta/core/format/xml/file_inside.h>

#include <filesystem>

namespace momenta::reading {
namespace {

/// The shape of a <geometry>; false: not drawn, the reason is in `why`.
bool take_shape(const Node& geometry, const std::string& file, VisualSpec& visual,
                std::string& why) {
  why = "visual shapes of no kind that is drawn, or without a size";
  if (const auto box = geometry.child("box")) {
    visual.kind = "box";
    const std::vector<double> size = box->required("size").content_numbers(3);
    visual.size = {size[0], size[1], size[2]};
  } else if (const auto sphere = geometry.child("sphere")) {
    visual.kind = "sphere";
    visual.size[0] = sphere->required("radius").content_number();
    return visual.size[0] > 0;
  } else if (const auto ellipsoid = geometry.child("ellipsoid")) {
    visual.kind = "ellipsoid";
    const std::vector<double> radii = ellipsoid->required("radii").content_numbers(3);
    visual.size = {radii[0], radii[1], radii[2]};
  } else if (const auto mesh = geometry.child("mesh")) {
    visual.kind = "mesh";
    visual.size.setOnes();
    if (const auto scale = mesh->child("scale")) {
      const std::vector<double> x = scale->content_numbers(3);
      visual.size = {x[0], x[1], x[2]};
    }
    visual.file = mesh_path(mesh->required("uri").content(), file);
    if (visual.file.empty())
      why = "meshes to draw whose files are not there";
    else if (is_mesh_file(visual.file))
      return true;
    else
      why = "meshes to draw that are no STL, OBJ or MSH";
    return false;
  } else {
    for (const char* kind : {"cylinder", "capsule"})
      if (const auto round = geometry.child(kind)) {
        visual.kind = kind;
        visual.size = {round->required("length").content_number(),
                       round->required("radius").content_number(), 0};
        return visual.size.head<2>().minCoeff() > 0;
      }
    return false;
  }
  return visual.size.minCoeff() > 0;
}

void draw_visual(const Node& part, const std::string& body, SdfModel& model) {
  VisualSpec visual;
  visual.body = body;
  visual.at = part.at();
  std::string why = "visual shapes without a geometry";
  const auto geometry = part.child("geometry");
  if (!geometry || !take_shape(*geometry, part.file(), visual, why))
    return model.remarks.left_out(why);
  if (!relative_to(part, "").empty())
    return model.remarks.left_out("visual shapes that are placed by other frames than their links");
  const Pose pose = read_pose(part);
  visual.position = pose.origin;
  visual.rotation = pose.turn;
  if (const auto material = part.child("material"))
    if (const auto diffuse = material->child("diffuse")) {
      const std::vector<double> rgb = diffuse->content_numbers();
      if (rgb.size() != 3 && rgb.size() != 4)
        diffuse->fail("has " + std::to_string(rgb.size()) + " numbers, expected 3 or 4");
      visual.colour = Eigen::Vector3d(rgb[0], rgb[1], rgb[2]).cwiseMax(0).cwiseMin(1);
    }
  // The path is relative to the folder of the scene.
  if (!visual.file.empty() && part.file() != model.scene.file) {
    namespace fs = std::filesystem;
    visual.file = (fs::path(part.file()).parent_path() / visual.file)
                      .lexically_relative(fs::path(model.scene.file).parent_path())
                      .string();
  }
  model.scene.visuals.push_back(std::move(visual));
}

}  // namespace

void draw_sdf_link(const Node& link, const std::string& body, SdfModel& model) {
  for (const Node& part : link.children("visual")) try {
      draw_visual(part, body, model);
    } catch (const SceneError& error) {
      model.remarks.not_drawn(error);
    }
}

}  // namespace momenta::reading
