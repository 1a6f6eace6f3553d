#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/effort_report.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/sampled_curves.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

/// Range along the motion.
struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  double at_most = 0;  ///< time of the largest |value| [s]
  double largest = 0, square = 0;
  int count = 0;

  void take(double t, double x) {
    if (std::isnan(x)) return;
    least = std::min(least, x);
    most = std::max(most, x);
    if (std::abs(x) > largest || count == 0) {
      largest = std::abs(x);
      at_most = t;
    }
    square += x * x;
    ++count;
  }
  double rms() const { return count > 0 ? std::sqrt(square / count) : 0; }
  Json json() const {
    return {{"least", number_or_null(least)},
            {"largest", number_or_null(most)},
            {"rms", number_or_null(rms())},
            {"largest_size_at", number_or_null(at_most)}};
  }
};

template <class Value>
Extent extent(const EffortResult& r, Value value) {
  Extent e;
  for (const EffortRow& row : r.rows) e.take(row.t, value(row));
  return e;
}

Extent extent_of(const EffortResult& r, Eigen::VectorXd EffortRow::*what, std::size_t actuator) {
  return extent(
      r, [&](const EffortRow& row) { return (row.*what)[static_cast<Eigen::Index>(actuator)]; });
}

std::string number_of(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::vector<double> times_of(const EffortResult& r) {
  std::vector<double> times;
  for (const EffortRow& row : r.rows) times.push_back(row.t);
  return times;
}

Column power_column(const Actuator& a) {
  return {a.name + ".power", "W"};
}

Column thrust_column(const Actuator& a) {
  return {a.name + ".thrust", "N"};
}

}  // namespace

std::string effort_in_words(const EffortResult& r) {
  const std::size_t n = r.actuators.size();
  std::string who = n > 0 && n <= 3 ? "" : number_of(n, "actuator");
  for (std::size_t i = 0; i < n && n <= 3; ++i)
    who += (i == 0 ? "" : i + 1 == n ? " and " : ", ") + r.actuators[i].name;
  std::string text = who + (n == 1 ? " holds " : " hold ") +
                     (r.poses_alone ? number_of(r.rows.size(), "pose") + " at rest"
                                    : "the motion of " + number_of(r.given, "coordinate") + " at " +
                                          number_of(r.rows.size(), "time")) +
                     ".";
  if (r.redundant > 0)
    text += " " + std::to_string(r.redundant) + " more than it needs: of all efforts that do, " +
            "these are the least by their weights.";
  if (r.unactuated > 0)
    text += " " + number_of(static_cast<std::size_t>(r.unactuated), "motion") +
            (r.unactuated == 1 ? " has" : " have") + " no actuator, and" +
            (r.unactuated == 1 ? " needs" : " need") + " none: what is missing is at most " +
            compact(r.missing, 2) + " of the forces there.";
  return text;
}

std::string effort_table(const EffortResult& r) {
  std::string text = (r.scene.empty() ? "" : r.scene + ": ") + effort_in_words(r) + "\n";
  std::vector<std::vector<std::string>> rows{
      {"actuator", "least", "largest", "rms", "largest at [s]", "power [W]"}};
  if (r.has_thrust()) rows.front().push_back("thrust [N]");
  const auto range = [](const Extent& e) {
    return e.count == 0 ? std::string("-") : compact(e.least, 4) + " to " + compact(e.most, 4);
  };
  for (std::size_t i = 0; i < r.actuators.size(); ++i) {
    const Extent effort = extent_of(r, &EffortRow::effort, i);
    rows.push_back({r.actuators[i].effort.label(), compact(effort.least, 5),
                    compact(effort.most, 5), compact(effort.rms(), 5), compact(effort.at_most, 4),
                    range(extent_of(r, &EffortRow::power, i))});
    if (r.has_thrust()) rows.back().push_back(range(extent_of(r, &EffortRow::thrust, i)));
  }
  return text + "\n" + in_columns(rows);
}

std::string effort_csv(const EffortResult& r) {
  std::vector<std::string> cells{"t [s]"};
  const auto head = [&](const Column& c) { cells.push_back(csv_cell(c.label())); };
  for (const Column& c : r.coordinates) head(c);
  for (const Column& c : r.rates) head(c);
  for (const Column& c : r.rates) head(acceleration_column(c));
  for (const Actuator& a : r.actuators) head(a.effort);
  for (const Actuator& a : r.actuators) head(power_column(a));
  for (const Actuator& a : r.actuators)
    if (a.helical >= 0) head(thrust_column(a));
  head({"power", "W"});
  std::string text = csv_line(cells);
  for (const EffortRow& row : r.rows) {
    cells = {round_trip(row.t)};
    for (const Eigen::VectorXd* x : {&row.q, &row.u, &row.udot, &row.effort, &row.power})
      for (const double value : *x) cells.push_back(round_trip(value));
    for (std::size_t i = 0; i < r.actuators.size(); ++i)
      if (r.actuators[i].helical >= 0)
        cells.push_back(round_trip(row.thrust[static_cast<Eigen::Index>(i)]));
    cells.push_back(round_trip(row.power.sum()));
    text += csv_line(cells);
  }
  return text;
}

Json effort_json(const EffortResult& r) {
  Json actuators = Json::array();
  for (std::size_t i = 0; i < r.actuators.size(); ++i) {
    const Actuator& a = r.actuators[i];
    Json one = {{"name", a.name},
                {"unit", a.effort.unit},
                {"weight", number_or_null(a.weight)},
                {"effort", extent_of(r, &EffortRow::effort, i).json()},
                {"power", extent_of(r, &EffortRow::power, i).json()}};
    if (a.helical >= 0) one["thrust"] = extent_of(r, &EffortRow::thrust, i).json();
    actuators.push_back(one);
  }
  return {{"scene", r.scene},
          {"kind", r.poses_alone ? "static" : "motion"},
          {"rows", r.rows.size()},
          {"start", number_or_null(r.rows.empty() ? NAN : r.rows.front().t)},
          {"end", number_or_null(r.rows.empty() ? NAN : r.rows.back().t)},
          {"given", r.given},
          {"redundant", r.redundant},
          {"unactuated", r.unactuated},
          {"missing", number_or_null(r.missing)},
          {"gap", number_or_null(r.gap)},
          {"actuators", actuators},
          {"power", extent(r, [](const EffortRow& row) { return row.power.sum(); }).json()}};
}

Film effort_film(const EffortResult& r, int intervals) {
  return film_of(
      times_of(r), [&](std::size_t i) -> const Eigen::VectorXd& { return r.rows[i].q; }, intervals);
}

Json effort_charts(const EffortResult& r) {
  Json charts = Json::array();
  const std::vector<double> times = times_of(r);
  using Curves = std::vector<std::pair<std::string, std::vector<double>>>;
  const auto add = [&](const std::string& key, const std::string& title, const std::string& unit,
                       Curves curves) {
    const std::string of = curves.size() == 1 ? " of " + curves.front().first : "s";
    add_chart(charts, times,
              {key, title + of + " [" + unit + "]", "", unit, "effort.csv", std::move(curves)});
  };
  const auto curve = [&](auto value) {
    std::vector<double> y;
    for (const EffortRow& row : r.rows) y.push_back(value(row));
    return y;
  };
  std::vector<std::string> units;
  for (const Actuator& a : r.actuators)
    if (std::find(units.begin(), units.end(), a.effort.unit) == units.end())
      units.push_back(a.effort.unit);
  Curves powers, thrusts;
  for (const std::string& unit : units) {
    Curves efforts;
    for (std::size_t i = 0; i < r.actuators.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (r.actuators[i].effort.unit == unit)
        efforts.emplace_back(r.actuators[i].name,
                             curve([k](const EffortRow& row) { return row.effort[k]; }));
    }
    add("effort_" + unit, "effort", unit, efforts);
  }
  for (std::size_t i = 0; i < r.actuators.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    powers.emplace_back(r.actuators[i].name,
                        curve([k](const EffortRow& row) { return row.power[k]; }));
    if (r.actuators[i].helical >= 0)
      thrusts.emplace_back(r.actuators[i].name,
                           curve([k](const EffortRow& row) { return row.thrust[k]; }));
  }
  add("thrust", "thrust", "N", thrusts);
  if (!r.poses_alone) {
    if (powers.size() > 1)
      powers.emplace_back("all", curve([](const EffortRow& row) { return row.power.sum(); }));
    add("power", "power", "W", powers);
  }
  for (const std::string unit : {"rad", "m"}) {
    Curves places;
    for (std::size_t i = 0; i < r.coordinates.size(); ++i)
      if (r.coordinates[i].unit == unit) {
        const auto k = static_cast<Eigen::Index>(i);
        places.emplace_back(r.coordinates[i].name,
                            curve([k](const EffortRow& row) { return row.q[k]; }));
      }
    add("q_" + unit, "coordinate", unit, places);
  }
  return charts;
}

}  // namespace momenta
