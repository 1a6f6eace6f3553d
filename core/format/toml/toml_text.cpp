#include <momenta/core/format/toml/toml_text.h>
#include <momenta/core/text/quoting.h>

#include <cmath>

namespace momenta::toml_text {
namespace {

template <class List>
std::string in_brackets(const List& values) {
  std::string all;
  for (const auto& value : values) all += (all.empty() ? "" : ", ") + of(value);
  return "[" + all + "]";
}

}  // namespace

std::string of(double value) {
  const bool large = std::abs(value) >= 1e15, minus_zero = value == 0 && std::signbit(value);
  std::string text = reading::digits(value);
  if ((large || minus_zero) && text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string of(bool value) {
  return value ? "true" : "false";
}

std::string of(const std::string& text) {
  static constexpr char hex[] = "0123456789abcdef";
  std::string all = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') all += '\\';
    if (byte < 0x20 || byte == 0x7f) {
      all += "\\u00";
      all += hex[byte >> 4];
      all += hex[byte & 15];
    } else {
      all += c;
    }
  }
  return all + "\"";
}

std::string of(const std::vector<double>& values) {
  return in_brackets(values);
}

std::string of(const Eigen::Vector3d& v) {
  return of(std::vector<double>(v.begin(), v.end()));
}

std::string of(const std::vector<Eigen::Vector3d>& points) {
  return in_brackets(points);
}

std::string of(const std::vector<std::string>& texts) {
  return in_brackets(texts);
}

bool same(double a, double b) {
  return a == b && std::signbit(a) == std::signbit(b);
}

bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]);
}

}  // namespace momenta::toml_text
