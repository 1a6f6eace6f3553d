#pragma once
// Result files are replaced whole or not at all.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

struct ResultFile {
  std::filesystem::path path;
  std::string content;
};

/// Writes each file as a PartFile, and gives them their names once all are on the disk; makes
/// missing directories. Returns nothing, or one sentence with a path and the system's message: then
/// files that were there are unchanged (unless a rename fails after others, as where a directory
/// has the name), and no temporary is left.
[[nodiscard]] std::optional<std::string> atomic_write(const std::vector<ResultFile>& files);

[[nodiscard]] std::optional<std::string> atomic_write(const std::filesystem::path& path,
                                                      std::string_view content);

/// Syncs a written file and gives it its name. On failure it is removed.
[[nodiscard]] std::optional<std::string> put_in_place(const std::filesystem::path& temporary,
                                                      const std::filesystem::path& path);

}  // namespace momenta
