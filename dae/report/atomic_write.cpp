#include <momenta/dae/report/atomic_write.h>
#include <momenta/dae/report/part_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <list>
#include <system_error>

namespace momenta {
namespace {

// Only then does a new entry survive a crash. Without it the file is still whole.
void sync_directory(const std::filesystem::path& directory) {
  const int handle = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  [[maybe_unused]] const int ignored = ::fsync(handle);
  ::close(handle);
}

}  // namespace

std::optional<std::string> atomic_write(const std::vector<ResultFile>& files) {
  std::list<PartFile> parts;
  for (const ResultFile& file : files) {
    PartFile& part = parts.emplace_back(file.path);
    if (!part.append(file.content) || !part.sync()) return part.problem();
  }
  for (PartFile& part : parts)
    if (!part.put_in_place()) return part.problem();
  return std::nullopt;
}

std::optional<std::string> atomic_write(const std::filesystem::path& path,
                                        std::string_view content) {
  PartFile part(path);
  if (part.append(content) && part.put_in_place()) return std::nullopt;
  return part.problem();
}

std::optional<std::string> put_in_place(const std::filesystem::path& temporary,
                                        const std::filesystem::path& path) {
  const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  int error = file < 0 ? errno : 0;
  // EINVAL: no fsync on this file system; the rename is still atomic.
  if (error == 0 && ::fsync(file) != 0 && errno != EINVAL) error = errno;
  if (file >= 0 && ::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return "Cannot write " + path.string() + ": " + std::generic_category().message(error) + ".";
  }
  sync_directory(path.has_parent_path() ? path.parent_path() : ".");
  return std::nullopt;
}

}  // namespace momenta
