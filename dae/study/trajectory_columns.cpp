#include <momenta/dae/study/run_form.h>

namespace momenta {

std::vector<std::string> trajectory_columns(const Mechanism& mechanism) {
  std::vector<std::string> columns{"t [s]"};
  const auto add = [&](const std::vector<Column>& more) {
    for (const auto& c : more) columns.push_back(c.label());
  };
  add(mechanism.coordinate_columns());
  add(mechanism.rate_columns());
  add(mechanism.marker_columns());
  columns.emplace_back("energy [J]");
  if (mechanism.m() == 0) return columns;
  const bool lengths = mechanism.has_lengths();
  columns.emplace_back(lengths ? "position_drift [m]" : "position_drift [rad]");
  columns.emplace_back(lengths ? "velocity_drift [m/s]" : "velocity_drift [rad/s]");
  if (lengths && mechanism.has_angles()) {
    columns.emplace_back("angle_drift [rad]");
    columns.emplace_back("angle_rate_drift [rad/s]");
  }
  std::string loop;
  int number = 0;
  const auto end_loop = [&] {
    if (number > 0) columns.push_back(loop + ".undetermined [1]");
  };
  for (std::size_t i = 0; i < mechanism.rows().size(); ++i) {
    const RowName& row = mechanism.rows()[i];
    if (row.loop != loop) end_loop();
    number = row.loop == loop ? number + 1 : 1;
    loop = row.loop;
    columns.push_back(loop + ".lambda" + std::to_string(number) +
                      (mechanism.angle_rows()[i] ? " [N m]" : " [N]"));
  }
  end_loop();
  return columns;
}

}  // namespace momenta
