#pragma once
// URDF, with the tags that URDF+ adds for loops and gears, and the YAML file that may stand beside
// it. What is read, what is left out and what is refused: docs/reference/formats.md.

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/urdf/read_options.h>
#include <momenta/core/scene/xml/made_scene.h>
#include <momenta/core/scene/xml/xml_node.h>

#include <map>
#include <string>

namespace momenta::reading {

/// The scene of a <robot>. `robot` and `file` outlive the call only. @throws SceneError
Scene read_urdf(const Element& robot, const std::string& file, const ReadOptions& options);

/// <origin xyz rpy> of an element: position, and R = Rz(y) Ry(p) Rx(r), or by quat_xyzw a
/// quaternion. Both are zero where it, or its attribute, is missing.
struct Origin {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};
Origin read_origin(const Node& node);

/// What a link called "ground" is called in the scene, where that is what does not move.
inline constexpr const char* ground_link = "ground 2";
/// The robot with such a link renamed, unless it is the root and welded, and so the ground itself.
/// @returns whether it was
bool rename_ground(Element& robot, bool free);

/// Hangs the root, the only link that is no joint's child, on the ground by a joint in front of all
/// others: a weld, or a free joint. A root called "ground" is the ground itself. @returns whether
/// it was welded @throws SceneError for links that are not there, and unless the joints make one
/// tree
bool hang_root(Scene& scene, const Node& robot, const std::vector<Node>& links, bool free,
               FreeNames& edges);

/// Says so where a root that hang_root() welded looks like that of a robot which floats: it has a
/// mass, and at least two branches of moving joints that no loop ties together. @pre the scene is
/// valid
void tell_of_fixed_root(const Scene& scene, Remarks& remarks);

/// <transmission>: adds to the rotor_inertia of its joint. @throws SceneError
void read_transmission(const Node& transmission, Scene& scene, Remarks& remarks);

/// Colours of <material>s by name, of the robot and of its links.
std::map<std::string, Eigen::Vector3d> colours_of(const Node& robot, Remarks& remarks);

/// What the solids of a link are read with.
struct LinkDrawing {
  std::string body;  ///< its name
  const std::string& file;
  const std::map<std::string, Eigen::Vector3d>& materials;
};
/// The solids of a link: boxes, cylinders, spheres and meshes of its <visual>s, or of its
/// <collision>s where none of those can be drawn. What is not drawn is counted.
void draw_link(const Node& link, const LinkDrawing& drawing, std::vector<VisualSpec>& visuals,
               Remarks& remarks);

/// URDF+: <loop> and <coupling>, whose links stand in `scene` already.
void read_loop_tag(const Node& loop, Scene& scene, FreeNames& edges);
void read_coupling_tag(const Node& coupling, Scene& scene, FreeNames& edges);

/// <gazebo>: loops by its <joint>s, springs of joints, weights that it takes back. What else it has
/// is counted. `scene` has its links and joints already. @throws SceneError
void read_gazebo_tag(const Node& tag, Scene& scene, FreeNames& edges, Remarks& remarks);

/// A YAML file beside the URDF: `options.loops` or, where that is empty, the file under the URDF's
/// name that has `closed_loop` or `joint_name`. It gives joints the types that a URDF cannot say,
/// and loops: pairs of joints or links whose frames stay together, "3d" for their origins alone,
/// "6d" for their axes as well. `scene` has its joints already. @throws SceneError
void read_beside(const std::string& urdf, const ReadOptions& options, Scene& scene,
                 FreeNames& edges, Remarks& remarks);

}  // namespace momenta::reading
