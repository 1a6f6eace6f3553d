#pragma once
// Settings of <compiler>: notation of angles, masses of bodies, folder of meshes. They hold for one
// model; an attached model has its own.

#include <momenta/core/scene/mjcf/mjcf_frames.h>

#include <filesystem>

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

}  // namespace momenta::reading
