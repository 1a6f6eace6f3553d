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

// FILE.part, which becomes FILE once it is whole: neither readers nor a kill or a full disk ever
// meet half a result. The next writer of FILE replaces a FILE.part of a killed process. Devices,
// pipes and targets of links are written directly.

/// Every call is false after a failure: problem().
class PartFile {
 public:
  /// Makes FILE.part, and missing directories, locked against other processes. A file that starts
  /// with `before` is kept so far, else replaced by it.
  explicit PartFile(std::filesystem::path file, std::string_view before = {});
  /// Unless put in place, removes FILE.part, if it did not exist with its beginning, and an empty
  /// directory made for it.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// On failure a first part of `text` may be written: size().
  bool append(std::string_view text);
  /// Reserves `bytes` on the disk, before anything is appended.
  bool reserve(std::size_t bytes);
  /// Keeps the first `size` bytes, also after a failure.
  void cut(std::size_t size);
  std::size_t size() const { return size_; }
  /// Waits for the disk.
  bool sync();
  /// Gives the file its name, with whole content or that of cut(). On failure an existing file is
  /// unchanged.
  bool put_in_place();

  const std::filesystem::path& file() const { return file_; }
  /// First failure, a sentence with file and system's message; empty: none.
  const std::string& problem() const { return problem_; }

 private:
  bool open(std::string_view before);
  bool open_device();
  bool has_its_name() const;  ///< FILE.part was neither removed nor moved
  bool begins_with(std::string_view before) const;
  bool fail(int error);

  std::filesystem::path file_, target_, part_;  ///< as asked for; target of a link
  int descriptor_ = -1;
  std::size_t size_ = 0;
  bool made_directory_ = false, stood_there_ = false, is_device_ = false;
  std::string problem_;
};

}  // namespace momenta
