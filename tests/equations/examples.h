#pragma once
// Scenes of the folder of examples, by their names there.

#include <momenta/core/format/files/read_scene.h>

#include <filesystem>
#include <string>

namespace momenta::equations {

/// A file of the examples; a folder's name stands for its scene.toml.
inline std::filesystem::path example_file(const std::string& name) {
  const auto path = std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name;
  return path.has_extension() ? path : path / "scene.toml";
}

inline Scene example(const std::string& name) {
  return read_scene(example_file(name));
}

}  // namespace momenta::equations
