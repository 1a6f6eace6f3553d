#pragma once
// Numbers in the bytes and words of mesh files.

#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <Eigen/Core>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace momenta::reading {

/// A number of four bytes, little-endian as these files and this machine are.
template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  static_assert(sizeof(T) == 4);
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/// Three float32; `count` numbers the point in messages.
inline Eigen::Vector3d point_at(std::string_view bytes, std::size_t at, const std::string& file,
                                std::size_t count) {
  Eigen::Vector3d point;
  for (Eigen::Index k = 0; k < 3; ++k)
    point[k] = number_at<float>(bytes, at + 4 * static_cast<std::size_t>(k));
  if (!point.allFinite())
    fail(file, {},
         "point " + std::to_string(count) +
             " has a coordinate that is no number, expected finite coordinates");
  return point;
}

/// The next word of a line, removed from its front; empty: none left.
inline std::string_view next_word(std::string_view& line) {
  constexpr std::string_view space = " \t\r\v\f";
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(space)));
  const std::string_view word = line.substr(0, line.find_first_of(space));
  line.remove_prefix(word.size());
  return word;
}

/// The next word of a line as a finite number. @throws SceneError
inline double next_number(std::string_view& line, const std::string& file, int at) {
  std::string_view word = next_word(line);
  const std::string_view whole = word;
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || stop != word.data() + word.size() || error != std::errc() ||
      !std::isfinite(value))
    fail(file, {at, 0}, "has " + in_quotes(whole) + ", expected a finite coordinate");
  return value;
}

/// Lines of a text, with their numbers from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }
  int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

}  // namespace momenta::reading
