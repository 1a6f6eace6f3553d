#include <momenta/dae/study/run_form.h>

#include <set>

namespace momenta {
namespace {

/// Couplers that tie angles alone, by name: their λ is a moment.
std::set<std::string> couplers_of_angles(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  std::set<std::string> names;
  for (const LoopSpec& l : mechanism.scene().loops) {
    if (l.kind != LoopKind::coupler) continue;
    bool slides = false;
    for (std::size_t i = 0; i < l.joints.size(); ++i) {
      const int last = tree.carried_by(l.joints[i]);
      for (int k = tree.first_part(last); k <= last; ++k) {
        const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
        slides |= b.kind == JointKind::prismatic &&
                  b.coordinate == (l.coordinates.empty() ? 0 : l.coordinates[i]);
      }
    }
    if (!slides) names.insert(l.name);
  }
  return names;
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
  const std::set<std::string> of_angles = couplers_of_angles(mechanism);
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
                        (row.what.rfind("coupling", 0) == 0 && of_angles.count(loop) > 0);
    columns.push_back(loop + ".lambda" + std::to_string(number) + (couple ? " [N m]" : " [N]"));
  }
  end_loop();
  return columns;
}

}  // namespace momenta
