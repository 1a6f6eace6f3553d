#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/fit/measured_motion.h>
#include <momenta/dae/study/fit/named_table.h>

#include <algorithm>

namespace momenta {

MeasuredMotion read_measured(const std::filesystem::path& file, const Mechanism& mechanism) {
  NamedTableForm form{"file of a measured motion",
                      "times",
                      "is no time, coordinate, rate or marker",
                      "the times are the only column; expected what was measured then",
                      {{"t", "s"}},
                      0};
  for (const std::vector<Column>& columns :
       {mechanism.coordinate_columns(), mechanism.rate_columns(), mechanism.marker_columns()})
    form.known.insert(form.known.end(), columns.begin(), columns.end());
  const NamedTable table = read_named_table(file, form);
  MeasuredMotion measured;
  measured.file = file.string();
  std::vector<Eigen::Index> columns;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (table.columns[k] == form.whole) {
      measured.times.assign(table.values.col(column).begin(), table.values.col(column).end());
    } else {
      measured.quantities.push_back(form.known[table.columns[k]]);
      columns.push_back(column);
    }
  }
  if (measured.times.empty())
    throw SceneError(measured.file +
                     ":1: there is no column 't [s]'; expected the times of a measured motion, or, "
                     "for wanted poses, --sweep NAME");
  for (std::size_t i = 0; i < measured.times.size(); ++i) {
    const double t = measured.times[i];
    if (t < 0 || (i > 0 && !(t > measured.times[i - 1])))
      throw SceneError(measured.file + ":" + std::to_string(table.lines[i]) + ": found the time " +
                       reading::digits(t) +
                       "; expected times from 0 on, each after the one before");
  }
  if (measured.times.back() == 0)
    throw SceneError(measured.file + ":" + std::to_string(table.lines.back()) +
                     ": the last time is 0; expected one after the start of the motion");
  measured.values = table.values(Eigen::all, columns);
  return measured;
}

}  // namespace momenta
