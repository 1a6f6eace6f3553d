#pragma once
// URDF, with the tags that URDF+ adds for loops and gears, and the YAML file that may stand beside
// it. What is read, what is left out and what is refused: docs/reference/formats.md.

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/urdf/read_options.h>
#include <momenta/core/scene/xml/made_scene.h>
#include <momenta/core/scene/xml/xml_node.h>

#include <string>

namespace momenta::reading {

/// The scene of a <robot>. `robot` and `file` outlive the call only. @throws SceneError
Scene read_urdf(const Element& robot, const std::string& file, const ReadOptions& options);

/// <origin xyz rpy> of an element: position, and R = Rz(y) Ry(p) Rx(r). Both are zero where it, or
/// its attribute, is missing.
struct Origin {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};
Origin read_origin(const Node& node);

/// The solids of a link: boxes, cylinders and spheres of its <visual>s, or of its <collision>s
/// where those are all meshes. What is not drawn is counted.
void draw_link(const Node& link, std::vector<VisualSpec>& visuals, Remarks& remarks);

/// URDF+: <loop> and <coupling>, whose links stand in `scene` already.
void read_loop_tag(const Node& loop, Scene& scene, FreeNames& edges);
void read_coupling_tag(const Node& coupling, Scene& scene, FreeNames& edges);

/// The loops of a YAML file, `options.loops` or, where that is empty, the one that stands beside
/// the URDF under its name and has the key `closed_loop`: pairs of joints or links whose frames
/// stay together; `type` is "3d" for their origins alone, "6d" for their axes as well.
void read_loops_beside(const std::string& urdf, const ReadOptions& options, Scene& scene,
                       FreeNames& edges, Remarks& remarks);

}  // namespace momenta::reading
