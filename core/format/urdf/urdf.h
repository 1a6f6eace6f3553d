#pragma once
// URDF, with the tags of URDF+ for loops and gears, and a YAML file beside it. What is read, left
// out and refused: docs/reference/formats.md.

#include <momenta/core/format/urdf/read_options.h>
#include <momenta/core/format/xml/made_scene.h>
#include <momenta/core/format/xml/xml_node.h>
#include <momenta/core/scene/scene.h>

#include <map>
#include <string>

namespace momenta::reading {

/// The scene of a <robot>. `robot` and `file` need only outlive the call. @throws SceneError
Scene read_urdf(const Element& robot, const std::string& file, const ReadOptions& options);

/// <origin xyz rpy> of an element: position, and R = Rz(y) Ry(p) Rx(r), or by quat_xyzw a
/// quaternion. Default: zero.
struct Origin {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};
Origin read_origin(const Node& node);

/// The name in the scene of a moving link called "ground".
inline constexpr const char* ground_link = "ground 2";
/// Renames such a link, unless it is the root and welded, and so the ground itself. @returns
/// whether it did
bool rename_ground(Element& robot, bool free);

/// Joins the root, the only link that is no joint's child, to the ground, before all other joints:
/// by a weld, or a free joint. A root called "ground" is the ground itself. @returns whether it was
/// welded @throws SceneError for missing links, and unless the joints make one tree
bool hang_root(Scene& scene, const Node& robot, const std::vector<Node>& links, bool free,
               FreeNames& edges);

/// A remark where a root welded by hang_root() looks like that of a floating robot: with mass, and
/// at least two branches of moving joints that no loop ties together. @pre the scene is valid
void tell_of_fixed_root(const Scene& scene, Remarks& remarks);

/// <transmission>: adds to the rotor_inertia of its joint. @throws SceneError
void read_transmission(const Node& transmission, Scene& scene, Remarks& remarks);

/// Colours of <material>s by name, of the robot and of its links.
std::map<std::string, Eigen::Vector3d> colours_of(const Node& robot, Remarks& remarks);

/// Context for drawing the solids of a link.
struct LinkDrawing {
  std::string body;
  const std::string& file;
  const std::map<std::string, Eigen::Vector3d>& materials;
};
/// The solids of a link: boxes, cylinders, spheres and meshes of its <visual>s, or of its
/// <collision>s where none of those can be drawn. Others are counted.
void draw_link(const Node& link, const LinkDrawing& drawing, std::vector<VisualSpec>& visuals,
               Remarks& remarks);

/// URDF+: <loop> and <coupling>. @pre the links are in `scene`
void read_loop_tag(const Node& loop, Scene& scene, FreeNames& edges);
void read_coupling_tag(const Node& coupling, Scene& scene, FreeNames& edges);

/// <gazebo>: loops by its <joint>s, springs of joints, cancelled weights; the rest is counted. @pre
/// links and joints are in `scene` @throws SceneError
void read_gazebo_tag(const Node& tag, Scene& scene, FreeNames& edges, Remarks& remarks);

/// Reads a YAML file: `options.loops` or, if empty, the file under the URDF's name that has
/// `closed_loop` or `joint_name`. It gives joints types that a URDF lacks, and loops: pairs of
/// joints or links whose frames stay together, "3d" for origins alone, "6d" for axes as well. @pre
/// the joints are in `scene` @throws SceneError
void read_beside(const std::string& urdf, const ReadOptions& options, Scene& scene,
                 FreeNames& edges, Remarks& remarks);

}  // namespace momenta::reading
