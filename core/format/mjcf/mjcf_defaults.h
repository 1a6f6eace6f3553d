#pragma once
// Settings of <compiler>: notation of angles, masses of bodies, folder of meshes. They hold for one
// model; an attached model has its own.

#include <momenta/core/format/mjcf/mjcf_frames.h>
#include <momenta/core/format/xml/xml_node.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace momenta::reading {

struct MjcfSettings {
  std::string from_attached;  ///< `model` of their <attach>; empty: none
  MjcfAngles angles;
  bool geoms_weigh = true, always_geoms = false;   ///< inertiafromgeom
  double least_group = -1e9, largest_group = 1e9;  ///< groups of geoms that weigh
  std::filesystem::path meshes;                    ///< folder of meshes, relative to the model's
  double least_mass = 0, least_moment = 0;         ///< boundmass, boundinertia [kg, kg m²]
  bool balances = false;                           ///< balanceinertia
  double total_mass = 0;                           ///< settotalmass [kg]; none: 0
  bool exact_meshes = false;  ///< exactmeshinertia: meshes are solids themselves, not their hulls
  bool auto_limits = true;    ///< autolimits: a range limits by default
  bool bare_names = false;    ///< strippath: file names without folders
};

/// Takes the attributes of a <compiler>; others stay. @throws SceneError
void read_compiler(const Node& node, MjcfSettings& settings);

// <default> classes of MJCF: attributes of elements that do not write them themselves.

class MjcfDefaults {
 public:
  /// The class of everything without another one.
  static constexpr const char* main_class = "main";

  MjcfDefaults() { classes_[main_class]; }

  /// Takes a top <default>. A class inherits all attributes of its parent, whatever their order.
  void take(const Node& node);
  /// Takes the classes of an attached model, with its prefix; its main class inherits nothing.
  void take(const MjcfDefaults& attached, const std::string& prefix);

  /// The element with the attributes of its `class`, else of `active`, added. `kind`: its name in
  /// the defaults: "joint", "geom", "site", "equality". An orientation of the element itself
  /// replaces any in the class. @throws SceneError for an unknown class
  Element with_defaults(const Node& node, const std::string& kind, const std::string& active) const;

  /// `childclass` of a body, else the one around it.
  std::string active_class(const Node& body, const std::string& around) const;

 private:
  using Attributes = std::vector<Attribute>;
  using Class = std::map<std::string, Attributes>;
  void take(const Node& node, const std::string& name);
  const Class& known(const Node& node, const char* attribute, const std::string& name) const;
  std::map<std::string, Class> classes_;
};

}  // namespace momenta::reading
