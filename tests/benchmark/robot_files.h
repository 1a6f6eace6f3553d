#pragma once
// Robots to time: files of examples/models and of the folder that MOMENTA_MODELS names.

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

namespace momenta {

inline std::set<std::filesystem::path> robot_files() {
  std::set<std::filesystem::path> files;
  const auto take = [&](const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder)) return;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (const auto end = entry.path().extension(); end == ".urdf" || end == ".xml")
        files.insert(entry.path());
  };
  take(std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples/models");
  if (const char* folder = std::getenv("MOMENTA_MODELS")) take(folder);
  return files;
}

/// "folder/file"
inline std::string short_name(const std::filesystem::path& file) {
  return file.parent_path().filename().string() + "/" + file.filename().string();
}

}  // namespace momenta
