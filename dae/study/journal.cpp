#include <fcntl.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/journal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace momenta {
namespace {

using Line = nlohmann::json;

std::string word_for(int error) {
  return std::generic_category().message(error);
}

std::string whole_text(int descriptor) {
  std::string text;
  char piece[1 << 16];
  for (ssize_t size; (size = ::read(descriptor, piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(size));
  return text;
}

/// A string of the line, empty where there is none.
std::string text_at(const Line& line, const char* name) {
  const auto at = line.find(name);
  return at != line.end() && at->is_string() ? at->get<std::string>() : "";
}

std::string text_of(const Line& line) {
  return line.dump(-1, ' ', false, Line::error_handler_t::replace) + "\n";
}

}  // namespace

Journal::Journal(std::filesystem::path file, const Study& study)
    : file_(std::move(file)), study_(study.digest) {
  std::error_code failure;
  if (file_.has_parent_path()) std::filesystem::create_directories(file_.parent_path(), failure);
  if (failure)
    throw std::runtime_error("Cannot make the directory " + file_.parent_path().string() + ": " +
                             failure.message() + ".");
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw std::runtime_error("Cannot write " + file_.string() + ": " + word_for(errno) + ".");
  try {
    // Where the file system knows no locks, two studies at once are the user's to avoid.
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw std::invalid_argument(file_.string() +
                                  ": another study is at work in this directory; expected "
                                  "another --out");
    read(study);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  if (descriptor_ < 0) return;
  if (!holds_runs_) ::unlink(file_.c_str());
  ::close(descriptor_);
}

void Journal::read(const Study& study) {
  const std::string text = whole_text(descriptor_);
  std::size_t whole = 0;  // bytes of lines that can be read
  while (whole < text.size()) {
    const std::size_t end = text.find('\n', whole);
    if (end == std::string::npos) break;
    Line line = Line::parse(text.begin() + static_cast<std::ptrdiff_t>(whole),
                            text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    if (!line.is_object()) break;
    if (whole == 0) {
      if (text_at(line, "study") != study.digest) {
        if (end + 1 == text.size()) break;  // nothing would be lost
        throw std::invalid_argument(
            file_.string() + " belongs to an unfinished study, '" + text_at(line, "command") +
            "'; expected that command to finish it, another --out, or the file removed");
      }
      of_another_build_ = text_at(line, "build") != study.build;
      if (of_another_build_) break;
    } else {
      const std::string key = text_at(line, "key");
      if (key.empty() || !line.contains("record")) break;
      records_[key] = std::move(line["record"]);
    }
    whole = end + 1;
  }
  if (whole < text.size() && ::ftruncate(descriptor_, static_cast<off_t>(whole)) != 0)
    throw std::runtime_error("Cannot write " + file_.string() + ": " + word_for(errno) + ".");
  if (whole == 0)
    append(text_of({{"study", study.digest}, {"build", study.build}, {"command", study.command}}));
  if (!trouble_.empty()) throw std::runtime_error(trouble_);
  holds_runs_ = !records_.empty();
}

std::string Journal::build_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string first;
  std::getline(in, first);
  const Line line = Line::parse(first, nullptr, false);
  return line.is_object() ? text_at(line, "build") : "";
}

void Journal::append(const std::string& line) {
  if (!trouble_.empty()) return;  // half a line stands last: nothing may follow it
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t size = ::write(descriptor_, line.data() + written, line.size() - written);
    if (size >= 0) {
      written += static_cast<std::size_t>(size);
    } else if (errno != EINTR) {
      trouble_ = "Cannot write " + file_.string() + ": " + word_for(errno) + ".";
      return;
    }
  }
}

const nlohmann::json* Journal::find(const std::string& key) const {
  const auto at = records_.find(digest(study_ + key));
  return at == records_.end() ? nullptr : &at->second;
}

void Journal::add(const std::string& key, const nlohmann::json& record) {
  const std::string line = text_of({{"key", digest(study_ + key)}, {"record", record}});
  const std::lock_guard lock(turn_);
  append(line);
  holds_runs_ = true;
}

std::string Journal::trouble() const {
  const std::lock_guard lock(turn_);
  return trouble_;
}

void Journal::remove() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace momenta
