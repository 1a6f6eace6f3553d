#pragma once
// An SDF file between reading and the scene: links with their poses, and joints by the links they
// tie, of which a spanning tree becomes joints of the scene and the rest loops.

#include <momenta/core/scene/sdf/sdf_frames.h>
#include <momenta/core/scene/xml/made_scene.h>

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace momenta::reading {

/// A joint between two links. In the pose of the file all its coordinates are 0.
struct SdfJoint {
  JointSpec spec;            ///< name, kind, pitch, springs and dampers, rotor, place; no frames
  std::string parent;        ///< a body of the scene, or "ground"
  std::string child;         ///< the same
  Eigen::Vector3d origin;    ///< in the world
  Eigen::Vector3d axis;      ///< in the world, held by the parent
  Eigen::Vector3d axis2;     ///< universal: in the world, held by the child
  std::string scoped;        ///< its full name in the file
  bool carries = false;      ///< it has to be a joint of the tree: no loop can be it
  std::optional<Node> node;  ///< where it stands
};

/// factor · the angle or displacement of a joint about or along one of its axes.
struct SdfTerm {
  std::string joint;  ///< by its full name
  int axis = 0;       ///< 0: axis, 1: axis2
  double factor = 1;
};

/// Σ factor q = offset.
struct SdfCoupler {
  std::string name;
  std::vector<SdfTerm> terms;
  double offset = 0;
  std::optional<Node> node;
};

struct SdfModel {
  Scene scene;
  Remarks remarks;
  FreeNames edges, bodies;
  Frames frames;
  std::array<int, 2> version{1, 0};
  std::map<std::string, Pose> poses;   ///< of the bodies, in the world
  std::set<std::string> fixed;         ///< bodies of static models
  std::vector<std::string> canonical;  ///< bodies that carry a model, as it says
  std::vector<SdfJoint> joints;
  std::vector<std::pair<std::string, Node>> gears;  ///< <joint type="gearbox"> with its scope
  std::map<std::string, std::string> body_of;       ///< by the full name of a link

  bool one_model = false;  ///< names need none of a model in front
  /// What is called so in the file, with its models, in the scene.
  std::string in_scene(const std::string& full) const {
    const std::size_t model = full.find("::");
    return one_model && model != std::string::npos ? full.substr(model + 2) : full;
  }

  bool older_than(int minor) const { return version[0] == 1 && version[1] < minor; }
  /// The body of a link or frame; "ground" for the world.
  std::string body(const std::string& scope, const std::string& frame, const Node& asked) const;
};

/// <joint> of a scope, "" or "model::"; all links and frames stand in `model` already.
void read_sdf_joint(const Node& node, const std::string& scope, SdfModel& model,
                    std::vector<SdfCoupler>& couplers);
/// <joint type="gearbox">, after all other joints.
SdfCoupler read_sdf_gearbox(const Node& node, const std::string& scope, SdfModel& model);

/// <visual>s of a link as solids to be drawn; what is not drawn is counted.
void draw_sdf_link(const Node& link, const std::string& body, SdfModel& model);

/// `version` of an <sdf>: 1, and the number behind the dot.
std::array<int, 2> read_sdf_version(const Node& sdf);

/// The elements with the models of other files in the place of each <include>, whose `name`,
/// `static`, `pose` and `placement_frame` go before those of the model. A file is named by a path
/// from the folder of the file, or by "model://FOLDER"; it lies there or below, at most 10 files
/// deep; a folder stands for its model.sdf. `files` gets their names. @throws SceneError
Element with_sdf_includes(Element sdf, const std::string& file, std::vector<std::string>& files);

/// Makes joints and loops of the scene of what has been read.
void make_tree(SdfModel& model, const std::vector<SdfCoupler>& couplers);

}  // namespace momenta::reading
