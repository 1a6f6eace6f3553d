#include <momenta/dae/study/run_form.h>

namespace momenta {
namespace {

/// Whether a coupler ties angles alone, so that its λ is a moment.
bool couples_angles(const Mechanism& mechanism, const std::string& coupler) {
  for (const LoopSpec& l : mechanism.scene().loops)
    for (std::size_t i = 0; l.name == coupler && i < l.joints.size(); ++i)
      for (const Tree::Body& b : mechanism.tree().bodies)
        if (b.joint == l.joints[i] && b.kind == JointKind::prismatic &&
            b.coordinate == (l.coordinates.empty() ? 0 : l.coordinates[i]))
          return false;
  return true;
}

}  // namespace

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
  columns.emplace_back("position_drift [m]");
  columns.emplace_back("velocity_drift [m/s]");
  std::string loop;
  int number = 0;
  const auto end_loop = [&] {
    if (number > 0) columns.push_back(loop + ".undetermined [1]");
  };
  for (const auto& row : mechanism.rows()) {
    if (row.loop != loop) end_loop();
    number = row.loop == loop ? number + 1 : 1;
    loop = row.loop;
    const bool couple = row.what.find("against") != std::string::npos ||
                        row.what.rfind("angle", 0) == 0 ||
                        (row.what.rfind("coupling", 0) == 0 && couples_angles(mechanism, loop));
    columns.push_back(loop + ".lambda" + std::to_string(number) + (couple ? " [N m]" : " [N]"));
  }
  end_loop();
  return columns;
}

}  // namespace momenta
