// Keys shared by joints, loops and forces: kind, origin, rotation.

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {

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

Origins read_origins(const Fields& table) {
  Origins origins;
  if (const auto origin = table.table("origin")) {
    origin->allow({"parent", "child"});
    origins.parent = origin->vector("parent", {"m"}, origins.parent);
    origins.child = origin->vector("child", {"m"}, origins.child);
  }
  return origins;
}

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

}  // namespace momenta::reading
