#pragma once
// Reads a scene from a file of any supported format. This header also brings parse_scene(), for
// TOML text that is not in a file, and validate().

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/toml/parse_scene.h>
#include <momenta/core/scene/toml/setting.h>
#include <momenta/core/scene/urdf/read_options.h>
#include <momenta/core/scene/validate.h>

#include <array>
#include <filesystem>

namespace momenta {

/// Reads a scene. A file whose name ends in .urdf, .xml, .mjcf, .sdf, .world or .xacro is URDF,
/// MJCF or SDF, as its root element says; any other is TOML. @throws SceneError: one sentence with
/// file, line and column, the key or name at fault, what was found and what was expected. Cost
/// O(size of file); files over 64 MiB are refused without reading them.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});
/// With other numbers in it. @throws std::invalid_argument for a place that the scene does not
/// have, and for a file that is not TOML
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options,
                 const std::vector<Setting>& settings);

/// Gives the limits of joints stops: stiffness [N m/rad or N/m] and damping [N m s/rad or N s/m],
/// of joints that have none of their own and are not driven. @throws SceneError for numbers that
/// are negative or not finite
void stop_at_limits(Scene& scene, const std::array<double, 2>& stops);

/// Whether read_scene() reads this file as TOML: false for the endings of XML above.
bool is_toml(const std::filesystem::path& file);

}  // namespace momenta
