// Efforts along a given motion.

#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/effort/effort.h>

#include <optional>

#include "bindings.h"

namespace momenta::python {

namespace {

/// A table of arrays, named by column with or without unit.
Reference table_of(const Mechanism& mechanism, const py::dict& motion) {
  std::vector<Column> known = mechanism.coordinate_columns();
  for (const Column& rate : mechanism.rate_columns()) known.push_back(rate);
  for (const Column& rate : mechanism.rate_columns()) known.push_back(acceleration_column(rate));
  std::vector<double> t;
  std::vector<std::string> columns;
  std::vector<Vector> values;
  for (const auto& [key, array] : motion) {
    const auto name = py::cast<std::string>(key);
    const auto column = py::cast<Vector>(array);
    if (!column.allFinite())
      throw py::value_error("motion: " + reading::in_quotes(name) +
                            " has a number that is not finite, expected finite ones");
    if (name == "t" || name == "t [s]") {
      t.assign(column.begin(), column.end());
      continue;
    }
    const auto found = std::find_if(known.begin(), known.end(), [&](const Column& c) {
      return c.name == name || c.label() == name;
    });
    if (found == known.end())
      throw py::value_error("motion: column " + reading::in_quotes(name) +
                            " is not known; expected t, or for instance " +
                            reading::in_quotes(known.empty() ? "" : known.front().name));
    columns.push_back(found->label());
    values.push_back(column);
  }
  if (t.empty()) throw py::value_error("motion has no t; expected times [s]");
  for (std::size_t i = 1; i < t.size(); ++i)
    if (!(t[i] > t[i - 1]))
      throw py::value_error("motion: t does not increase, expected a later time in each row");
  std::vector<std::vector<double>> rows(t.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k].size() != static_cast<Eigen::Index>(t.size()))
      throw py::value_error("motion: " + reading::in_quotes(columns[k]) + " has " +
                            std::to_string(values[k].size()) + " numbers, expected " +
                            std::to_string(t.size()) + " as t has");
    for (std::size_t i = 0; i < t.size(); ++i)
      rows[i].push_back(values[k][static_cast<Eigen::Index>(i)]);
  }
  return Reference("motion", columns, t, rows);
}

py::dict effort(const Bench& b, const std::optional<py::dict>& motion,
                const std::vector<std::string>& actuate,
                const std::map<std::string, double>& weights, const std::vector<std::string>& hold,
                bool poses_alone, std::optional<double> end, std::optional<int> samples,
                double within) {
  const Scene& driven = b.mechanism->scene();
  const Mechanism mechanism(undriven(driven), b.mechanism->options());
  std::optional<Reference> table;
  EffortRequest request;
  if (motion) {
    table.emplace(table_of(mechanism, *motion));
    request.motion.table = &*table;
  } else if (driven.drives.empty() && !poses_alone) {
    throw py::value_error("the scene has no drives; expected a motion, or static=True");
  }
  const double last = end.value_or(driven.run.end_time);
  const int count = samples.value_or(driven.run.samples);
  constexpr int most = 1'000'000;
  if (!(last > 0) || !std::isfinite(last) || count < 1 || count > most)
    throw py::value_error("end and samples: expected a time above zero and 1 to " +
                          std::to_string(most) + " intervals");
  request.motion.drives = driven.drives;
  request.motion.hold = hold;
  request.motion.poses_alone = poses_alone;
  request.motion.times = {0};
  if (!driven.drives.empty())
    for (int i = 1; i <= count; ++i) request.motion.times.push_back(last * i / count);
  request.actuated = actuate;
  request.weights.assign(weights.begin(), weights.end());
  request.within = within;
  EffortResult r;
  {
    const py::gil_scoped_release others_go_on;
    r = momenta::effort(mechanism, request);
  }
  const auto rows = static_cast<Eigen::Index>(r.rows.size());
  const auto actuators = static_cast<Eigen::Index>(r.actuators.size());
  Vector t(rows);
  Rows q(rows, mechanism.nq()), u(rows, mechanism.nv()), udot(rows, mechanism.nv());
  Rows efforts(rows, actuators), power(rows, actuators), thrust(rows, actuators);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const EffortRow& row = r.rows[static_cast<std::size_t>(i)];
    t[i] = row.t;
    q.row(i) = row.q;
    u.row(i) = row.u;
    udot.row(i) = row.udot;
    efforts.row(i) = row.effort;
    power.row(i) = row.power;
    thrust.row(i) = row.thrust;
  }
  std::vector<std::string> names, coordinates, rates;
  for (const Actuator& a : r.actuators) names.push_back(a.name);
  for (const Column& c : r.coordinates) coordinates.push_back(c.name);
  for (const Column& c : r.rates) rates.push_back(c.name);
  py::dict all;
  all["t"] = std::move(t);
  all["actuators"] = names;
  all["coordinates"] = coordinates;
  all["rates"] = rates;
  all["q"] = std::move(q);
  all["u"] = std::move(u);
  all["udot"] = std::move(udot);
  all["effort"] = std::move(efforts);
  all["power"] = std::move(power);
  all["thrust"] = std::move(thrust);
  all["redundant"] = r.redundant;
  all["unactuated"] = r.unactuated;
  all["gap"] = r.gap;
  return all;
}

}  // namespace

void add_effort(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "effort", &effort, py::kw_only(), "motion"_a = py::none(),
      "actuate"_a = std::vector<std::string>(), "weights"_a = std::map<std::string, double>(),
      "hold"_a = std::vector<std::string>(), "static"_a = false, "end"_a = py::none(),
      "samples"_a = py::none(), "within"_a = 1e-6,
      "Inverse dynamics: efforts along a motion, loops closed, as a dict: t (rows) [s]; effort "
      "(rows, actuators) [N m or N], power (rows, actuators) [W], thrust (rows, actuators) [N], "
      "not "
      "a number of joints that are not helical; names of actuators, coordinates and rates; q "
      "(rows, "
      "nq), u and udot (rows, nv) of the mechanism without its drives; redundant, unactuated, gap. "
      "`motion`: a dict of arrays, 't' and columns such as 'O.q', 'O.u', 'O.udot' (None: the "
      "motion "
      "of the drives, to `end` [s] in `samples` intervals); `actuate`: actuated coordinates "
      "(empty: the "
      "driven ones; without drives and loops all); `weights`: of squared efforts where actuators "
      "work against each other; `hold`: coordinates that stay; `static`: each pose at rest; "
      "`within`: how far loops may move what is given, in lengths of the scene. Raises SceneError "
      "where loops cannot follow, coordinates are left open or nothing holds the motion. Cost: "
      "O(bodies) a row, and dense decompositions of the rates that loops tie together.");
}

}  // namespace momenta::python
