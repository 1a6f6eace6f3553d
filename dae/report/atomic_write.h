#pragma once
// Files that are either whole or not there: a reader never sees half a result, nor does a full disk
// leave one.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace momenta {

/// Writes `content` to `path` by way of a temporary file in the same directory (write, fsync,
/// rename); missing directories are made. Nothing on success, else one sentence with the path and
/// the system's word for the cause; then a file that stood there before is unchanged and no
/// temporary is left.
[[nodiscard]] std::optional<std::string> atomic_write(const std::filesystem::path& path,
                                                      std::string_view content);

/// The second half of it: a temporary file that is written and closed reaches the disk and gets its
/// name. On failure it is removed.
[[nodiscard]] std::optional<std::string> put_in_place(const std::filesystem::path& temporary,
                                                      const std::filesystem::path& path);

}  // namespace momenta
