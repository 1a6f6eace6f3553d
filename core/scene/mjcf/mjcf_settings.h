#pragma once
// What <compiler> says: how angles are written, what weighs a body, where meshes lie. It holds for
// one model; an attached model has its own.

#include <momenta/core/scene/mjcf/mjcf_frames.h>

#include <filesystem>

namespace momenta::reading {

struct MjcfSettings {
  std::string from_attached;  ///< the `model` of the <attach> they came with; empty: none
  MjcfAngles angles;
  bool geoms_weigh = true, always_geoms = false;   ///< inertiafromgeom
  double least_group = -1e9, largest_group = 1e9;  ///< of geoms that weigh
  std::filesystem::path meshes;                    ///< folder of meshes, from that of the model
  double least_mass = 0, least_moment = 0;         ///< boundmass, boundinertia [kg, kg m²]
  bool balances = false;                           ///< balanceinertia
  double total_mass = 0;                           ///< settotalmass [kg]; none: 0
  bool exact_meshes = false;  ///< exactmeshinertia: meshes are solids as they are, not their hulls
  bool auto_limits = true;    ///< autolimits: a range limits where nothing else is said
  bool bare_names = false;    ///< strippath: names of files without folders
};

/// Takes what a <compiler> says over what is there. @throws SceneError
void read_compiler(const Node& node, MjcfSettings& settings);

}  // namespace momenta::reading
