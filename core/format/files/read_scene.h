#pragma once
// Reads a scene from a file of any supported format. Also brings parse_scene(), for TOML text
// without a file, and validate().

#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/setting.h>
#include <momenta/core/format/urdf/read_options.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/validate.h>

#include <array>
#include <filesystem>

namespace momenta {

/// Reads a scene: .urdf, .xml, .mjcf, .sdf, .world or .xacro as URDF, MJCF or SDF, by the root
/// element; any other file as TOML. @throws SceneError: one sentence with file, line and column,
/// the key or name at fault, what was found and what was expected. Cost O(size of file); files over
/// 64 MiB are refused unread.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});
/// The same with other numbers in it. @throws std::invalid_argument for a place that the scene does
/// not have, and for a file that is not TOML
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options,
                 const std::vector<Setting>& settings);

/// Gives stops, stiffness [N m/rad or N/m] and damping [N m s/rad or N s/m], to the limits of
/// joints without their own that are not driven. @throws SceneError for numbers that are negative
/// or not finite
void stop_at_limits(Scene& scene, const std::array<double, 2>& stops);

/// Whether read_scene() reads this file as TOML: false for the endings of XML above.
bool is_toml(const std::filesystem::path& file);

}  // namespace momenta
