#pragma once
#include <momenta/core/scene/scene.h>

#include <filesystem>
#include <string_view>

namespace momenta {

/// What a URDF does not say.
struct ReadOptions {
  /// YAML file with the loops; empty: the one beside the URDF under its name, if there is one.
  std::filesystem::path loops;
  bool free_root = false;  ///< the root link floats; else it is fixed to the ground
};

/// Reads a scene: URDF or MJCF where the file ends in .urdf, .xml or .mjcf, by its root element,
/// else TOML. @throws SceneError: one sentence with file, line and column, the key or name at
/// fault, what was found and what was expected. Cost O(size of file); files over 64 MiB are refused
/// unread.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

/// False for the endings .urdf, .xml and .mjcf.
bool is_toml(const std::filesystem::path& file);

/// A scene from TOML; `file` only names it in messages.
Scene parse_scene(std::string_view text, const std::string& file = "scene");

/// Everything that can be told from the scene alone: names unique and known, masses, inertias
/// (triangle inequality), finite numbers, sizes of position and velocity, every body the child of
/// exactly one joint, no cycle among the joints, drives and torques on joints that can take them.
/// Called by the reader; call it for scenes built by hand.
/// @throws SceneError
void validate(const Scene& scene);

}  // namespace momenta
