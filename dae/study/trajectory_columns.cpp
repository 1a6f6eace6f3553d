#include <momenta/dae/joint_places.h>
#include <momenta/dae/study/run_form.h>

namespace momenta {

std::vector<std::string> trajectory_columns(const Mechanism& mechanism, bool reactions) {
  std::vector<std::string> columns{"t [s]"};
  const auto add = [&](const std::vector<Column>& more) {
    for (const auto& c : more) columns.push_back(c.label());
  };
  add(mechanism.coordinate_columns());
  add(mechanism.rate_columns());
  add(mechanism.marker_columns());
  columns.emplace_back("energy [J]");
  if (mechanism.m() > 0) {
    const bool lengths = mechanism.has_lengths();
    columns.emplace_back(lengths ? "position_drift [m]" : "position_drift [rad]");
    columns.emplace_back(lengths ? "velocity_drift [m/s]" : "velocity_drift [rad/s]");
    if (lengths && mechanism.has_angles()) {
      columns.emplace_back("angle_drift [rad]");
      columns.emplace_back("angle_rate_drift [rad/s]");
    }
    const std::vector<Column> multipliers = mechanism.multiplier_columns();
    const std::vector<RowName>& rows = mechanism.rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      columns.push_back(multipliers[i].label());
      if (i + 1 == rows.size() || rows[i + 1].loop != rows[i].loop)
        columns.push_back(rows[i].loop + ".undetermined [1]");
    }
  }
  add(mechanism.effort_columns());
  if (reactions && !mechanism.scene().lagrangian)
    for (const JointPlace& joint : joint_places(mechanism)) {
      for (const char* axis : {".force_x", ".force_y", ".force_z"})
        columns.push_back(joint.name + axis + " [N]");
      for (const char* axis : {".torque_x", ".torque_y", ".torque_z"})
        columns.push_back(joint.name + axis + " [N m]");
    }
  return columns;
}

}  // namespace momenta
