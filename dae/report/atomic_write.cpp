#include <momenta/dae/report/atomic_write.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace momenta {
namespace {

std::string cause(int error) {
  return std::generic_category().message(error);
}

// 0, or the errno of the call that failed. The descriptor is closed in either case.
int write_and_close(int file, std::string_view content) {
  int error = 0;
  while (!content.empty() && error == 0) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written >= 0) {
      content.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  // EINVAL: the file system knows no fsync for this file; the rename is atomic all the same.
  if (error == 0 && ::fsync(file) != 0 && errno != EINVAL) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

// The new directory entry survives a crash only once the directory itself is on disk; where that
// cannot be asked for, the file is whole nevertheless.
void sync_directory(const std::filesystem::path& directory) {
  const int handle = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  [[maybe_unused]] const int ignored = ::fsync(handle);
  ::close(handle);
}

}  // namespace

std::optional<std::string> atomic_write(const std::filesystem::path& path,
                                        std::string_view content) {
  const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code failure;
  std::filesystem::create_directories(directory, failure);
  if (failure) {
    return "Cannot make the directory " + directory.string() + ": " + failure.message() + ".";
  }

  // O_EXCL with a name of process and count: neither another thread nor another process shares it.
  static std::atomic<unsigned> count{0};
  std::filesystem::path temporary = path;
  temporary += "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".part";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return "Cannot write " + path.string() + ": " + cause(errno) + ".";

  if (const int error = write_and_close(file, content)) {
    ::unlink(temporary.c_str());
    return "Cannot write " + path.string() + ": " + cause(error) + ".";
  }
  return put_in_place(temporary, path);
}

std::optional<std::string> put_in_place(const std::filesystem::path& temporary,
                                        const std::filesystem::path& path) {
  const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  int error = file < 0 ? errno : write_and_close(file, {});
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return "Cannot write " + path.string() + ": " + cause(error) + ".";
  }
  sync_directory(path.has_parent_path() ? path.parent_path() : ".");
  return std::nullopt;
}

}  // namespace momenta
