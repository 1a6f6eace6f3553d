#include <momenta/core/text/near_name.h>
#include <momenta/dae/kinematics/coordinate_place.h>

#include <vector>

namespace momenta {

std::pair<int, int> coordinate_place(const Mechanism& mechanism, const std::string& name) {
  const std::vector<Column> columns = mechanism.coordinate_columns();
  std::vector<std::string> known;
  for (const auto& body : mechanism.tree().bodies) {
    if (body.nq != body.nv) continue;  // quaternions
    for (int i = 0; i < body.nq; ++i) {
      const std::string& column = columns[static_cast<std::size_t>(body.q + i)].name;
      known.push_back(column);
      if (column == name || (body.nq == 1 && column == name + ".q"))
        return {body.q + i, body.u + i};
    }
  }
  throw SceneError("coordinate '" + name + "' is not known; expected " +
                   reading::all_in_quotes(known));
}

}  // namespace momenta
