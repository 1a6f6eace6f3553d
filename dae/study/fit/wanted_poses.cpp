#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/study/fit/named_table.h>
#include <momenta/dae/study/fit/wanted_poses.h>

namespace momenta {

WantedPoses read_wanted(const std::filesystem::path& file, const Mechanism& mechanism,
                        const std::string& sweep) {
  NamedTableForm form{"file of wanted poses",
                      "poses",
                      "is no coordinate and no position of a marker",
                      "the swept coordinate is the only column; expected what it is to move",
                      mechanism.coordinate_columns(),
                      static_cast<std::size_t>(coordinate_named(mechanism, sweep).first)};
  std::vector<WantedPoses::Quantity> quantities;
  for (const Column& q : form.known)
    quantities.push_back({q.name, q.unit, static_cast<int>(quantities.size()), -1, 0});
  const std::vector<Column> markers = mechanism.marker_columns();
  for (std::size_t i = 0; i < markers.size(); ++i)
    if (i % 6 < 3) {
      form.known.push_back(markers[i]);
      quantities.push_back(
          {markers[i].name, markers[i].unit, -1, static_cast<int>(i / 6), static_cast<int>(i % 6)});
    }
  const NamedTable table = read_named_table(file, form);
  WantedPoses wanted;
  wanted.file = file.string();
  std::vector<Eigen::Index> asked;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (table.columns[k] == form.whole) {
      wanted.swept.assign(table.values.col(column).begin(), table.values.col(column).end());
    } else {
      wanted.quantities.push_back(quantities[table.columns[k]]);
      asked.push_back(column);
    }
  }
  wanted.values = table.values(Eigen::all, asked);
  return wanted;
}

}  // namespace momenta
