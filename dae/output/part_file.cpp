#include <momenta/dae/output/part_file.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <list>
#include <system_error>
#include <utility>

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

PartFile::PartFile(std::filesystem::path file, std::string_view before)
    : file_(std::move(file)), target_(file_) {
  std::error_code unknown;
  is_device_ = is_other(std::filesystem::status(file_, unknown));
  if (is_symlink(file_, unknown)) target_ = canonical(file_, unknown);
  if (target_.empty()) target_ = file_;
  part_ = target_;
  part_ += ".part";
  const auto directory = file_.parent_path();
  std::error_code failure;
  if (!directory.empty()) made_directory_ = create_directories(directory, failure);
  if (failure)
    problem_ = "Cannot make the directory " + directory.string() + ": " + failure.message() + ".";
  else if (is_device_)
    open_device();
  else
    open(before);
}

PartFile::~PartFile() {
  if (descriptor_ >= 0) {
    if (!stood_there_ && !is_device_ && has_its_name()) ::unlink(part_.c_str());
    ::close(descriptor_);
  }
  std::error_code not_empty;
  if (made_directory_) std::filesystem::remove(file_.parent_path(), not_empty);
}

bool PartFile::open_device() {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
  return descriptor_ >= 0 || fail(errno);
}

bool PartFile::has_its_name() const {
  struct stat own {
  }, named{};
  return ::fstat(descriptor_, &own) == 0 && ::stat(part_.c_str(), &named) == 0 &&
         own.st_ino == named.st_ino && own.st_dev == named.st_dev;
}

bool PartFile::begins_with(std::string_view before) const {
  char piece[1 << 16];
  while (!before.empty()) {
    const ssize_t size = ::read(descriptor_, piece, std::min(sizeof piece, before.size()));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0 || !before.starts_with({piece, static_cast<std::size_t>(size)})) return false;
    before.remove_prefix(static_cast<std::size_t>(size));
  }
  return true;
}

bool PartFile::open(std::string_view before) {
  // A lock, not O_EXCL: it ends with its process. Without locks users have to avoid two writers.
  while (true) {
    descriptor_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) return fail(errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      problem_ = "Cannot write " + file_.string() + ": another process is writing it.";
    } else if (!has_its_name()) {
      ::close(descriptor_);  // another process has just put it in place
      continue;
    } else {
      stood_there_ = !before.empty() && begins_with(before);
      size_ = stood_there_ ? before.size() : 0;
      const auto end = static_cast<off_t>(size_);
      if (::ftruncate(descriptor_, end) != 0 || ::lseek(descriptor_, end, SEEK_SET) < 0)
        fail(errno);
      else
        append(before.substr(size_));
      if (!problem_.empty() && !stood_there_) ::unlink(part_.c_str());
    }
    if (problem_.empty()) return true;
    ::close(descriptor_);
    descriptor_ = -1;
    return false;
  }
}

bool PartFile::fail(int error) {
  if (problem_.empty())
    problem_ =
        "Cannot write " + file_.string() + ": " + std::generic_category().message(error) + ".";
  return false;
}

bool PartFile::append(std::string_view text) {
  if (!problem_.empty()) return false;
  if (!is_device_ && !has_its_name()) return fail(ENOENT);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail(errno);
    size_ += static_cast<std::size_t>(written);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool PartFile::reserve(std::size_t bytes) {
  if (!problem_.empty()) return false;
  const int error = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes));
  // EINVAL, EOPNOTSUPP: no reservation, but there may be room.
  return error == 0 || error == EINVAL || error == EOPNOTSUPP || fail(error);
}

void PartFile::cut(std::size_t size) {
  if (descriptor_ < 0) return;
  size_ = size;
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail(errno);
}

bool PartFile::sync() {
  if (!problem_.empty()) return false;
  // EINVAL: no fsync on this file system; the rename is still atomic.
  return ::fsync(descriptor_) == 0 || errno == EINVAL || fail(errno);
}

bool PartFile::put_in_place() {
  if (descriptor_ < 0) return false;
  if (is_device_) {
    const int error = ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno;
    return problem_.empty() && (error == 0 || fail(error));
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) return fail(errno);  // reserved
  const auto trouble = momenta::put_in_place(part_, target_);
  ::close(descriptor_);
  descriptor_ = -1;
  if (!trouble) return true;
  if (problem_.empty()) problem_ = *trouble;
  return false;
}

}  // namespace momenta
