#include <momenta/core/text/near_name.h>
#include <momenta/dae/kinematics/coordinate_named.h>

namespace momenta {

std::pair<int, int> coordinate_named(const Mechanism& mechanism, const std::string& name) {
  const std::vector<Column> columns = mechanism.coordinate_columns();
  std::vector<std::string> known;
  const auto is_it = [&](int q, bool alone) {
    const std::string& column = columns[static_cast<std::size_t>(q)].name;
    known.push_back(column);
    return column == name || (alone && column == name + ".q");
  };
  if (mechanism.scene().lagrangian)
    for (int i = 0; i < mechanism.nq(); ++i)
      if (is_it(i, false)) return {i, i};
  for (const auto& body : mechanism.tree().bodies) {
    if (body.nq != body.nv) continue;  // quaternions
    for (int i = 0; i < body.nq; ++i)
      if (is_it(body.q + i, body.nq == 1)) return {body.q + i, body.u + i};
  }
  throw SceneError("coordinate '" + name + "' is not known; expected " +
                   reading::all_in_quotes(known));
}

}  // namespace momenta
