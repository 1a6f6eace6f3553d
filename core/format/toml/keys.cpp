#include <momenta/core/format/toml/keys.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {
namespace {

using toml_text::same;

Eigen::Quaterniond read_rotation(const Fields& table) {
  const auto rotation = table.table("rotation");
  if (!rotation) return Eigen::Quaterniond::Identity();
  rotation->allow({"rpy", "quaternion", "axis", "angle"});
  const int ways = rotation->has("rpy") + rotation->has("quaternion") +
                   (rotation->has("axis") || rotation->has("angle"));
  if (ways != 1)
    table.fail_key("rotation", "is given in " + std::to_string(ways) +
                                   " ways, expected one of: rpy, quaternion, axis with angle");

  using Turn = Eigen::AngleAxisd;
  if (rotation->has("rpy")) {
    const Eigen::Vector3d rpy = rotation->vector("rpy", {"rad"});
    return Turn(rpy[2], Eigen::Vector3d::UnitZ()) * Turn(rpy[1], Eigen::Vector3d::UnitY()) *
           Turn(rpy[0], Eigen::Vector3d::UnitX());
  }
  if (rotation->has("quaternion")) {
    const std::vector<double> wxyz = rotation->numbers("quaternion", {});
    if (wxyz.size() != 4)
      rotation->fail_key("quaternion",
                         "has " + std::to_string(wxyz.size()) + " entries, expected w, x, y, z");
    const Eigen::Quaterniond quaternion(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    const double norm = quaternion.norm();
    if (!(std::abs(norm - 1) <= norm_slack))
      rotation->fail_key("quaternion", "has the norm " + digits(norm) + ", expected 1 within 1e-6");
    return is_unit(quaternion) ? quaternion : quaternion.normalized();
  }
  const double angle = rotation->number("angle", {"rad"});
  if (!rotation->has("axis")) table.fail_key("rotation", "has an angle and no axis, expected both");
  return Eigen::Quaterniond(Turn(angle, rotation->direction("axis", Eigen::Vector3d::UnitZ())));
}

}  // namespace

std::size_t read_kind(const Fields& table, std::span<const std::string_view> kinds,
                      std::string_view key, std::span<const std::string_view> others,
                      std::string_view table_of_others) {
  const std::string kind = table.text(key);
  const auto found = std::find(kinds.begin(), kinds.end(), kind);
  if (found != kinds.end()) return static_cast<std::size_t>(found - kinds.begin());

  std::string sentence = "is " + in_quotes(kind);
  if (std::find(others.begin(), others.end(), kind) != others.end())
    sentence += ", which only a " + std::string(table_of_others) + " can be";
  table.fail_key(key, sentence + ", expected one of: " + listed(kinds) + did_you_mean(kind, kinds));
}

void Keys::put(std::string_view key, const std::string& value) {
  if (!value.empty()) written_.push_back({place_, std::string(key) + " = " + value});
}

std::string Keys::joined(const char* between, const char* last) {
  std::stable_sort(written_.begin(), written_.end(),
                   [](const Line& a, const Line& b) { return a.place < b.place; });
  std::string all;
  for (const Line& line : written_) all += line.text + (&line == &written_.back() ? last : between);
  return all;
}

void Keys::refuse(std::string_view key, const std::string& reason) const {
  if (names()) in_->refuse(key, reason);
}

void Keys::word(std::string_view name, std::string_view text) {
  if (names()) names_.push_back(name);
  if (writes()) put(name, toml_text::of(std::string(text)));
}

void Keys::optional_name(std::string& name) {
  value_or<std::string>("name", name, "");
  if (reads() && name.empty() && in_->has("name"))
    in_->fail_key("name", "is empty, expected a name or no such key");
}

void Keys::choice(std::string_view name, std::string& text,
                  std::span<const std::string_view> kinds) {
  if (!has(name, text != kinds.front())) return;
  if (reads()) text = kinds[read_kind(*in_, kinds, name)];
  word(name, text);
}

void Keys::formula(std::string_view name, std::string& formula) {
  if (writes() && formula.empty()) return;
  value(name, formula);
  if (reads() && formula.empty()) in_->fail_key(name, "is empty, expected a formula");
}

void Keys::whole(std::string_view name, int& n, int least, int otherwise) {
  if (names()) names_.push_back(name);
  if (reads()) n = least > 0 ? in_->count(name, otherwise) : in_->index(name, otherwise);
  if (writes() && n != otherwise) put(name, std::to_string(n));
}

void Keys::direction(std::string_view name, Eigen::Vector3d& v, const Eigen::Vector3d& otherwise) {
  if (names()) names_.push_back(name);
  if (reads()) v = in_->direction(name, otherwise);
  if (writes() && !same(v, otherwise)) put(name, toml_text::of(v));
}

void Keys::rotation(Eigen::Quaterniond& r) {
  if (names()) names_.push_back("rotation");
  if (reads()) r = read_rotation(*in_);
  if (writes() && !(same(r.w(), 1) && same(r.vec(), Eigen::Vector3d::Zero())))
    put("rotation",
        "{ quaternion = " + toml_text::of(std::vector{r.w(), r.x(), r.y(), r.z()}) + " }");
}

}  // namespace momenta::reading
