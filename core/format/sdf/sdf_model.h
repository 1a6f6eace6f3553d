#pragma once
// An SDF file between reading and the scene: links with poses, and joints with their links, of
// which a spanning tree becomes joints of the scene and the rest loops.

#include <momenta/core/format/sdf/sdf_frames.h>
#include <momenta/core/format/xml/made_scene.h>

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace momenta::reading {

/// A joint between two links, with all coordinates 0 in the pose of the file.
struct SdfJoint {
  JointSpec spec;            ///< name, kind, pitch, springs and dampers, rotor, place; no frames
  std::string parent;        ///< a body of the scene, or "ground"
  std::string child;         ///< the same
  Eigen::Vector3d origin;    ///< in the world
  Eigen::Vector3d axis;      ///< in the world, held by the parent
  Eigen::Vector3d axis2;     ///< universal: in the world, held by the child
  std::string scoped;        ///< full name in the file
  bool carries = false;      ///< must be a joint of the tree: it has no loop form
  std::optional<Node> node;  ///< its element
};

/// factor · angle or displacement of a joint about or along one of its axes.
struct SdfTerm {
  std::string joint;  ///< full name
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
  std::map<std::string, Pose> poses;   ///< poses of the bodies in the world
  std::set<std::string> fixed;         ///< bodies of static models
  std::vector<std::string> canonical;  ///< canonical bodies, which carry a model
  std::vector<SdfJoint> joints;
  std::vector<std::pair<std::string, Node>> gears;  ///< <joint type="gearbox"> with its scope
  std::map<std::string, std::string> body_of;       ///< by full name of a link

  bool one_model = false;  ///< names need no model in front
  /// The name in the scene of a full name in the file.
  std::string in_scene(const std::string& full) const {
    const std::size_t model = full.find("::");
    return one_model && model != std::string::npos ? full.substr(model + 2) : full;
  }

  bool older_than(int minor) const { return version[0] == 1 && version[1] < minor; }
  /// The body of a link or frame; "ground" for the world.
  std::string body(const std::string& scope, const std::string& frame, const Node& asked) const;
};

/// Reads a <joint> of a scope, "" or "model::". @pre all links and frames are in `model`
void read_sdf_joint(const Node& node, const std::string& scope, SdfModel& model,
                    std::vector<SdfCoupler>& couplers);
/// Reads a <joint type="gearbox">, after all other joints.
SdfCoupler read_sdf_gearbox(const Node& node, const std::string& scope, SdfModel& model);

/// Draws the <visual>s of a link; those that cannot be drawn are counted.
void draw_sdf_link(const Node& link, const std::string& body, SdfModel& model);

/// `version` of an <sdf>: 1, and the number after the dot.
std::array<int, 2> read_sdf_version(const Node& sdf);

/// The elements with each <include> replaced by the model of its file; its `name`, `static`, `pose`
/// and `placement_frame` override those of the model. A file is named by a path from the folder of
/// the file, or by "model://FOLDER"; it lies there or below, at most 10 files deep; a folder stands
/// for its model.sdf. `files` gets their names. @throws SceneError
Element with_sdf_includes(Element sdf, const std::string& file, std::vector<std::string>& files);

/// Makes joints and loops of the scene.
void make_tree(SdfModel& model, const std::vector<SdfCoupler>& couplers);

}  // namespace momenta::reading
