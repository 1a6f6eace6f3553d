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

/// Writes each by way of its PartFile, and gives them their names once all are on the disk; missing
/// directories are made. Nothing on success, else one sentence with a path and the system's word
/// for the cause: then files that stood there before are unchanged (but for a rename that fails
/// after others, say where a directory has the name), and no temporary is left.
[[nodiscard]] std::optional<std::string> atomic_write(const std::vector<ResultFile>& files);

/// One file.
[[nodiscard]] std::optional<std::string> atomic_write(const std::filesystem::path& path,
                                                      std::string_view content);

/// The second half of it: a temporary file that is written reaches the disk and gets its name. On
/// failure it is removed.
[[nodiscard]] std::optional<std::string> put_in_place(const std::filesystem::path& temporary,
                                                      const std::filesystem::path& path);

}  // namespace momenta
