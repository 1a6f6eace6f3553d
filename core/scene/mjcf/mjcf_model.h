#pragma once
// What is known of an MJCF while it is read: settings, defaults, where everything stands at qpos0,
// and the scene that grows.

#include <momenta/core/scene/mjcf/mjcf_defaults.h>
#include <momenta/core/scene/mjcf/mjcf_frames.h>
#include <momenta/core/scene/xml/made_scene.h>

#include <map>
#include <string>
#include <vector>

namespace momenta::reading {

struct MjcfModel {
  Scene scene;
  Remarks remarks;
  FreeNames bodies, edges;
  MjcfAngles angles;
  MjcfDefaults defaults;
  bool geoms_weigh = true, always_geoms = false;   ///< inertiafromgeom
  double least_group = -1e9, largest_group = 1e9;  ///< of geoms that weigh

  /// Bodies by name with their frames at qpos0; "world" is the ground.
  std::map<std::string, MjcfFrame> frames{{"world", {}}};
  struct Site {
    std::string body;
    MjcfFrame frame;  ///< in the body
  };
  std::map<std::string, Site> sites;

  /// The name of a body in the scene.
  static std::string in_scene(const std::string& body) { return body == "world" ? "ground" : body; }
};

/// The bodies of a <worldbody>, with joints, springs, dampers and sites.
void read_worldbody(const Node& world, MjcfModel& model);

/// <equality>: connect, weld and joint become loops.
void read_equality(const Node& equality, MjcfModel& model);

}  // namespace momenta::reading
