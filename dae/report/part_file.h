#pragma once
// FILE.part, which becomes FILE once it is whole: a reader never sees half a result, nor does a
// kill or a full disk leave one. What a killed process left of a FILE.part, the next that writes
// FILE replaces. A device or a pipe cannot be whole or not: it is written to. So is what a link
// leads to.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace momenta {

/// Every call is false once something is amiss; problem() has the sentence with the file and the
/// system's word for the cause.
class PartFile {
 public:
  /// Makes FILE.part, and directories that are missing. It is this process's own while it lives.
  /// It begins with `before`: what stands there is kept so far where it does, else replaced.
  explicit PartFile(std::filesystem::path file, std::string_view before = {});
  /// Not put in place: removes FILE.part, unless it stood there with its beginning, and a directory
  /// made for it that is empty.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Where it fails, a first part of `text` may be written: size() tells.
  bool append(std::string_view text);
  /// Room on the disk for so many bytes, before anything is appended.
  bool reserve(std::size_t bytes);
  /// Drops all but the first `size` bytes, also after a failure.
  void cut(std::size_t size);
  std::size_t size() const { return size_; }
  /// Waits until what was appended is on the disk.
  bool sync();
  /// Gives the file its name, of whole content or of what cut() left. A file that stood there
  /// before is unchanged where this fails.
  bool put_in_place();

  const std::filesystem::path& file() const { return file_; }
  /// Empty: nothing is amiss.
  const std::string& problem() const { return problem_; }

 private:
  bool open(std::string_view before);
  bool open_device();
  bool has_its_name() const;  ///< nobody has removed or moved it
  bool begins_with(std::string_view before) const;
  bool fail(int error);

  std::filesystem::path file_, target_, part_;  ///< as asked for; what it leads to
  int descriptor_ = -1;
  std::size_t size_ = 0;
  bool made_directory_ = false, stood_there_ = false, is_device_ = false;
  std::string problem_;
};

}  // namespace momenta
