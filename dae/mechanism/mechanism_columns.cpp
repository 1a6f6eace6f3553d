// Names and units of the columns of results.

#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/dae/mechanism/mechanism.h>

namespace momenta {
namespace {

/// Name of the column of coordinate i of a joint without a quaternion; numbered where the scene's
/// joint has several coordinates.
std::string one_dof_column(const Tree::Body& b, const char* letter, int i = 0) {
  const bool several = b.parts > 1 || b.nv > 1;
  return b.joint + "." + letter + (several ? std::to_string(b.coordinate + i) : "");
}

}  // namespace

std::vector<Column> Mechanism::coordinate_columns() const {
  std::vector<Column> columns;
  if (scene_.lagrangian)
    for (const auto& c : scene_.lagrangian->coordinates) columns.push_back({c.name, c.unit});
  for (const auto& b : tree_.bodies) {
    if (!b.has_quaternion()) {
      for (int i = 0; i < b.nq; ++i)
        columns.push_back({one_dof_column(b, "q", i), b.is_length(i) ? "m" : "rad"});
      continue;
    }
    if (b.nq == 7)
      for (const char* axis : {".x", ".y", ".z"}) columns.push_back({b.joint + axis, "m"});
    for (const char* part : {".qw", ".qx", ".qy", ".qz"}) columns.push_back({b.joint + part, "1"});
  }
  return columns;
}

std::vector<Column> Mechanism::rate_columns() const {
  std::vector<Column> columns;
  if (scene_.lagrangian)
    for (const auto& c : scene_.lagrangian->coordinates)
      columns.push_back({LagrangianFormulas::rate_name(c.name), c.unit + "/s"});
  for (const auto& b : tree_.bodies) {
    if (!b.has_quaternion()) {
      for (int i = 0; i < b.nv; ++i)
        columns.push_back({one_dof_column(b, "u", i), b.is_length(i) ? "m/s" : "rad/s"});
      continue;
    }
    if (b.nv == 6)
      for (const char* axis : {".vx", ".vy", ".vz"}) columns.push_back({b.joint + axis, "m/s"});
    for (const char* axis : {".wx", ".wy", ".wz"}) columns.push_back({b.joint + axis, "rad/s"});
  }
  return columns;
}

std::vector<Column> Mechanism::marker_columns() const {
  std::vector<Column> columns;
  for (const auto& marker : scene_.markers) {
    for (const char* axis : {".x", ".y", ".z"}) columns.push_back({marker.name + axis, "m"});
    for (const char* axis : {".vx", ".vy", ".vz"}) columns.push_back({marker.name + axis, "m/s"});
  }
  return columns;
}

std::vector<Column> Mechanism::multiplier_columns() const {
  std::vector<Column> columns;
  int number = 0;
  for (std::size_t i = 0; i < row_names_.size(); ++i) {
    const std::string& loop = row_names_[i].loop;
    number = i > 0 && row_names_[i - 1].loop == loop ? number + 1 : 1;
    columns.push_back({loop + ".lambda" + std::to_string(number), angle_rows_[i] ? "N m" : "N"});
  }
  return columns;
}

std::vector<Column> Mechanism::effort_columns() const {
  std::vector<Column> columns(tree_.drives.size());
  for (const auto& b : tree_.bodies)
    if (b.drive >= 0)
      columns[static_cast<std::size_t>(b.drive)] = {one_dof_column(b, "effort"),
                                                    b.kind == JointKind::prismatic ? "N" : "N m"};
  return columns;
}

}  // namespace momenta
