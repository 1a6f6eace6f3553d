#pragma once
// <asset><mesh>: solids whose mass geoms may have. A mesh is read when a body is weighed by it, not
// before: those for the eye alone need not be there.

#include <momenta/core/scene/mesh/mesh_mass.h>
#include <momenta/core/scene/mjcf/mjcf_settings.h>
#include <momenta/core/scene/xml/remarks.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace momenta::reading {

class MjcfMeshes {
 public:
  /// A <mesh> with its defaults, of a model in `folder`. @throws SceneError for a name that is
  /// taken
  void take(const Node& mesh, const std::filesystem::path& folder, const MjcfSettings& settings);

  /// Volume or area, centre of mass and inertia, for a density of one and in the geom's axes, of
  /// the mesh that a geom names:
  ///   p ← scale · R(refquat)ᵀ (p − refpos)
  /// for its points p, and by `inertia`: of the inside of its convex hull (convex), of its own
  /// inside (exact), by pyramids (legacy, MuJoCo's default), of the surface (shell, or `shell`).
  const MeshMass& of(const Node& geom, bool shell, Remarks& remarks);

  /// The mesh that a geom names, to be drawn where `at` puts the geom in its body; its file from
  /// `scene`, the folder of the model. Nothing, and the reason as a plural: one whose file is not
  /// there or of no kind that is read, or which no factors and one turn place.
  std::optional<VisualSpec> drawn(const Node& geom, const MjcfFrame& at,
                                  const std::filesystem::path& scene, std::string& why) const;

 private:
  struct Asset {
    Element element;
    std::string file;  ///< where the element stands
    std::filesystem::path folder;
    MjcfSettings settings;
    mutable std::optional<MeshMass> solid, shell;  ///< weighed when asked for
  };
  static Mesh read(const Node& node, const Asset& asset, std::string& what);
  const Asset& asset(const Node& geom) const;
  std::map<std::string, Asset> assets_;
};

}  // namespace momenta::reading
