#pragma once
// A scene from a file, in whichever format. The readers of the formats stand below; with this
// header come parse_scene() for TOML that is no file, and validate().

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/toml/parse_scene.h>
#include <momenta/core/scene/urdf/read_options.h>
#include <momenta/core/scene/validate.h>

#include <filesystem>

namespace momenta {

/// Reads a scene: URDF or MJCF where the file ends in .urdf, .xml or .mjcf, by its root element,
/// else TOML. @throws SceneError: one sentence with file, line and column, the key or name at
/// fault, what was found and what was expected. Cost O(size of file); files over 64 MiB are refused
/// unread.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

/// False for the endings .urdf, .xml and .mjcf.
bool is_toml(const std::filesystem::path& file);

}  // namespace momenta
