#pragma once
// TOML text as it is written, and parts common to several kinds of tables.

#include <momenta/core/scene/scene.h>
#include <momenta/core/text/near_name.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

namespace momenta {

/// Writes tables, with keys that differ from their default.
class TomlText {
 public:
  std::string text;

  void open(const char* header) { text += std::string("\n") + header + "\n"; }
  void put(const char* key, const std::string& value) {
    text += std::string(key) + " = " + value + "\n";
  }
  void word(const char* key, const std::string& value) { put(key, quoted(value)); }
  void number(const char* key, double value, double otherwise = 0) {
    if (!same(value, otherwise)) put(key, digits(value));
  }
  void numbers(const char* key, const std::vector<double>& values) { put(key, list(values)); }
  void vector(const char* key, const Eigen::Vector3d& v,
              const Eigen::Vector3d& otherwise = Eigen::Vector3d::Zero()) {
    if (!same(v, otherwise)) put(key, list({v[0], v[1], v[2]}));
  }

  void rotation(const Eigen::Quaterniond& r) {
    if (!same(r.w(), 1) || !same(r.vec(), Eigen::Vector3d::Zero()))
      put("rotation", "{ quaternion = " + list({r.w(), r.x(), r.y(), r.z()}) + " }");
  }

  /// Digits of a number; TOML's integers have no minus zero and end at 2^63.
  static std::string digits(double value) {
    const bool large = std::abs(value) >= 1e15, minus_zero = value == 0 && std::signbit(value);
    std::string text = reading::digits(value);
    if ((large || minus_zero) && text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
  }
  static std::string list(const std::vector<double>& values) {
    std::string all;
    for (const double value : values) all += (all.empty() ? "" : ", ") + digits(value);
    return "[" + all + "]";
  }
  static std::string words(const std::vector<std::string>& values) {
    std::string all;
    for (const std::string& value : values) all += (all.empty() ? "" : ", ") + quoted(value);
    return "[" + all + "]";
  }
  static std::string quoted(const std::string& value) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string all = "\"";
    for (const char c : value) {
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
  static bool same(double a, double b) { return a == b && std::signbit(a) == std::signbit(b); }
  static bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]);
  }
};

/// Writes two bodies and a point on each.
template <class Edge>
void write_ends(const Edge& e, TomlText& t) {
  if (e.parent != "ground") t.word("parent", e.parent);
  t.word("child", e.child);
  const bool one = !TomlText::same(e.origin_parent, Eigen::Vector3d::Zero());
  const bool two = !TomlText::same(e.origin_child, Eigen::Vector3d::Zero());
  const auto three = [](const Eigen::Vector3d& v) { return TomlText::list({v[0], v[1], v[2]}); };
  if (one || two)
    t.put("origin", "{ " + (one ? "parent = " + three(e.origin_parent) : std::string()) +
                        (one && two ? ", " : "") +
                        (two ? "child = " + three(e.origin_child) : std::string()) + " }");
}

/// Writes limits and stops of a joint or of a force along a length.
template <class Spec>
void write_limits(const Spec& spec, TomlText& t) {
  if (spec.limits) t.numbers("limits", {(*spec.limits)[0], (*spec.limits)[1]});
  t.number("stop_stiffness", spec.stop_stiffness);
  t.number("stop_damping", spec.stop_damping);
  t.number("stop_width", spec.stop_width, Spec{}.stop_width);
}

/// Writes Σ ratios q of joints.
template <class Sum>
void write_sum(const Sum& sum, TomlText& t) {
  t.put("joints", TomlText::words(sum.joints));
  t.numbers("ratios", sum.ratios);
  if (!sum.coordinates.empty())
    t.numbers("coordinates", {sum.coordinates.begin(), sum.coordinates.end()});
}

void write_joint(const JointSpec& joint, TomlText& t);
void write_loop(const LoopSpec& loop, TomlText& t);
void write_drive(const DriveSpec& drive, TomlText& t);
void write_force(const ForceSpec& force, TomlText& t);

}  // namespace momenta
