#pragma once
// What is known of an MJCF while it is read: settings, defaults, where everything stands at qpos0,
// and the scene that grows.

#include <momenta/core/scene/mjcf/mjcf_defaults.h>
#include <momenta/core/scene/mjcf/mjcf_meshes.h>
#include <momenta/core/scene/mjcf/mjcf_settings.h>
#include <momenta/core/scene/xml/made_scene.h>

#include <map>
#include <string>
#include <vector>

namespace momenta::reading {

/// The settings are those that hold where it is read.
struct MjcfModel : MjcfSettings {
  Scene scene;
  Remarks remarks;
  FreeNames bodies, edges;
  MjcfDefaults defaults;
  MjcfMeshes meshes;
  std::map<std::string, MjcfSettings> attached;  ///< of attached models, by the `model` of <attach>

  /// Bodies by name with their frames at qpos0; "world" is the ground.
  std::map<std::string, MjcfFrame> frames{{"world", {}}};
  struct Site {
    std::string body;
    MjcfFrame frame;  ///< in the body
  };
  std::map<std::string, Site> sites;
  std::map<std::string, double> refs;  ///< `ref` of each joint that has coordinates [rad or m]

  /// Geoms that can be drawn, and whether MuJoCo draws them by default.
  std::vector<std::pair<VisualSpec, bool>> drawn;
  std::map<std::string, Eigen::Vector3d> materials;  ///< colours by name

  /// The name of a body in the scene.
  static std::string in_scene(const std::string& body) { return body == "world" ? "ground" : body; }
};

/// The bodies of a <worldbody>, with joints, springs, dampers and sites.
void read_worldbody(const Node& world, MjcfModel& model);

/// <equality>: connect, weld and joint become loops.
void read_equality(const Node& equality, MjcfModel& model);

}  // namespace momenta::reading
