#pragma once
// <asset><mesh>: solids that weigh geoms. A mesh is read when it weighs a body, not before: drawn
// ones may be missing.

#include <momenta/core/format/mesh/mesh_mass.h>
#include <momenta/core/format/mjcf/mjcf_defaults.h>
#include <momenta/core/format/xml/made_scene.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace momenta::reading {

class MjcfMeshes {
 public:
  /// Takes a <mesh> with its defaults, of a model in `folder`. @throws SceneError for a name that
  /// is taken
  void take(const Node& mesh, const std::filesystem::path& folder, const MjcfSettings& settings);

  /// Volume or area, centre of mass and inertia, for density one and in the geom's axes, of the
  /// mesh named by a geom:
  ///   p ← scale · R(refquat)ᵀ (p − refpos)
  /// for its points p, and by `inertia`: of its convex hull (convex), of its inside (exact), by
  /// pyramids (legacy, MuJoCo's default), of the surface (shell, or `shell`).
  const MeshMass& of(const Node& geom, bool shell, Remarks& remarks);

  /// The mesh named by a geom, drawn where `at` puts the geom in its body; its file relative to
  /// `scene`, the folder of the model. Nothing, with the reason as a plural: its file is missing or
  /// of an unknown kind, or factors and a turn do not place it.
  std::optional<VisualSpec> drawn(const Node& geom, const MjcfFrame& at,
                                  const std::filesystem::path& scene, std::string& why) const;

 private:
  struct Asset {
    Element element;
    std::string file;  ///< file of the element
    std::filesystem::path folder;
    MjcfSettings settings;
    mutable std::optional<MeshMass> solid, shell;  ///< weighed when first needed
  };
  static Mesh read(const Node& node, const Asset& asset, std::string& what);
  const Asset& asset(const Node& geom) const;
  std::map<std::string, Asset> assets_;
};

}  // namespace momenta::reading
