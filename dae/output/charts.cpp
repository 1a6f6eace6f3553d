#include <momenta/dae/form/form.h>
#include <momenta/dae/output/chart.h>
#include <momenta/dae/output/run_label.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {
namespace {

constexpr double rounding_floor = 1e-17;  // lower end of logarithmic axes: rounding

bool any_finite(const std::vector<double>& y) {
  return std::any_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); });
}
bool any_but_zero(const std::vector<double>& y) {
  return std::any_of(y.begin(), y.end(), [](double v) { return std::isfinite(v) && v != 0; });
}
std::vector<double> sizes_of(std::vector<double> y) {
  for (double& v : y) v = std::isnan(v) ? v : std::max(std::abs(v), rounding_floor);
  return y;
}

Chart over_time(const std::string& key, const std::string& title, const std::string& y_title,
                const std::string& unit) {
  Chart chart;
  chart.key = key;
  chart.title = title;
  chart.x_title = "time t [s]";
  chart.y_title = y_title;
  chart.unit = unit;
  return chart;
}

/// Names of a trajectory's columns, by unit.
struct Quantity {
  const char *unit, *key, *title, *axis;
};
constexpr std::array<Quantity, 7> quantities{{{"rad", "angles", "Angles", "angle"},
                                              {"m", "positions", "Positions", "position"},
                                              {"rad/s", "angular_rates", "Angular rates", "rate"},
                                              {"m/s", "speeds", "Speeds", "speed"},
                                              {"1", "quaternions", "Quaternions", "part"},
                                              {"N", "forces", "Loop forces λ", "force"},
                                              {"N m", "moments", "Loop moments λ", "moment"}}};

/// Remark on a curve of loop forces that are not unique.
std::string remark(const RunResult& run, const std::string& column) {
  for (const RunResult::Undetermined& u : run.undetermined)
    if (u.column == column)
      return u.samples == static_cast<long>(run.series.t.size())
                 ? " (not unique)"
                 : " (not unique at " + std::to_string(u.samples) + " samples)";
  return "";
}

}  // namespace

std::vector<History> histories(const RunResult& run) {
  const std::string unit = drift_unit(run);
  return {
      {"position_drift",
       "Position drift",
       "position drift |Φ| [" + unit + "]",
       unit,
       &Series::position_drift,
       {1, 2}},
      {"velocity_drift",
       "Velocity drift",
       "velocity drift |Φ̇| [" + unit + "/s]",
       unit + "/s",
       &Series::velocity_drift,
       {1, 2}},
      {"angle_drift",
       "Position drift of angles",
       "drift |Φ| of angles [rad]",
       "rad",
       &Series::angle_drift,
       {1, 2}},
      {"angle_rate_drift",
       "Velocity drift of angles",
       "drift |Φ̇| of angles [rad/s]",
       "rad/s",
       &Series::angle_rate_drift,
       {1, 2}},
      {"energy_error", "Energy error", "energy error |E − E₀| [J]", "J", &Series::energy_error, {}},
      {"position_error",
       "Error against the reference",
       "error of positions max |err|/(1+|ref|)",
       "1",
       &Series::position_error,
       {}},
      {"force_error",
       "Error of λ from (3) against the reference",
       "error of λ, max |err|/(1+|ref|)",
       "1",
       &Series::force_error,
       {}},
      {"multiplier_error",
       "Error of the form's own λ against the reference",
       "error of λ, max |err|/(1+|ref|)",
       "1",
       &Series::multiplier_error,
       {}},
      {"multiplier_difference",
       "The form's own λ against λ from (3)",
       "difference, max |Δλ|/(1+|λ|)",
       "1",
       &Series::multiplier_difference,
       {}},
      {"momentum_error",
       "Error of p without its gauge",
       "error of p, max |err|/(1+|ref|)",
       "1",
       &Series::momentum_error,
       {}},
      {"impulse_error",
       "Error of the loops' impulses",
       "error of ∫λ dt, max |err|/(1+|ref|)",
       "1",
       &Series::impulse_error,
       {}},
      {"effort_error",
       "Error of the efforts of drives",
       "error of efforts, max |err|/(1+|ref|)",
       "1",
       &Series::effort_error,
       {}},
      {"reaction_error",
       "Error of the reactions of joints",
       "error of reactions, max |err|/(1+|ref|)",
       "1",
       &Series::reaction_error,
       {}},
      {"work_error",
       "Error of work",
       "error of work, |err|/(1+|ref|)",
       "1",
       &Series::work_error,
       {}},
      {"impulse", "Loop impulses", "loop impulses |σ| [N s]", "N s", &Series::impulse, {}}};
}

std::vector<Chart> charts_of_run(const RunResult& run) {
  std::vector<Chart> charts;
  for (const History& history : histories(run)) {
    const std::vector<double>& y = run.series.*history.values;
    const std::string key = history.key;
    // No curves of zeros, such as drifts without loops.
    if (!any_but_zero(y) || (key == "impulse" && !takes_gauge(run.settings.form))) continue;
    Chart chart = over_time(history.key, history.title, history.axis, history.unit);
    chart.log_y = true;
    chart.curves.push_back(
        {history.title, run.series.t, sizes_of(y), sign_in_turn(charts.size()), !finished(run)});
    charts.push_back(std::move(chart));
  }
  const Trajectory& trajectory = run.trajectory;
  if (trajectory.rows.empty()) return charts;
  std::map<std::string, std::vector<std::size_t>> by_unit;
  for (std::size_t c = 1; c < trajectory.columns.size(); ++c) {
    const std::string& label = trajectory.columns[c];
    const auto bracket = label.rfind(" [");
    const std::string name = label.substr(0, bracket);
    if (name == "energy" || name == "position_drift" || name == "velocity_drift" ||
        name == "angle_drift" || name == "angle_rate_drift" || name.ends_with(".undetermined"))
      continue;
    by_unit[label.substr(bracket + 2, label.size() - bracket - 3)].push_back(c);
  }
  const auto add = [&](const std::string& key, const std::string& title, const std::string& axis,
                       const std::string& unit) {
    Chart chart = over_time(key, title, axis + " [" + unit + "]", unit);
    const auto& columns = by_unit[unit];
    const auto of_loop = [&](std::size_t c) {
      return trajectory.columns[c].find(".lambda") != std::string::npos;
    };
    if (title.ends_with("λ") && !std::all_of(columns.begin(), columns.end(), of_loop))
      chart.title = unit == "N" ? "Forces" : "Moments";
    for (const std::size_t c : columns) {
      const std::string& label = trajectory.columns[c];
      Curve curve{label.substr(0, label.rfind(" [")) + remark(run, label),
                  {},
                  {},
                  sign_in_turn(chart.curves.size()),
                  !finished(run)};
      for (const auto& row : trajectory.rows) {
        curve.x.push_back(row[0]);
        curve.y.push_back(row[c]);
      }
      if (any_finite(curve.y)) chart.curves.push_back(std::move(curve));
    }
    by_unit.erase(unit);
    if (!chart.curves.empty()) charts.push_back(std::move(chart));
  };
  const bool quaternions = std::any_of(
      by_unit["1"].begin(), by_unit["1"].end(),
      [&](std::size_t c) { return trajectory.columns[c].find(".qw [") != std::string::npos; });
  for (const Quantity& q : quantities)
    if (quaternions || q.unit != std::string_view("1")) add(q.key, q.title, q.axis, q.unit);
  std::vector<std::string> others;  // units of a Lagrangian's own
  for (const auto& [unit, columns] : by_unit) others.push_back(unit);
  for (const std::string& unit : others)
    add("coordinates_" + std::to_string(charts.size()), "In " + unit, "value", unit);
  return charts;
}

namespace {

/// A measure against its cost.
struct Cost {
  const char *key, *title, *x_title;
  std::string y_title, unit;
  double (*x)(const RunResult&);
  double (*y)(const RunResult&);
};
double processor_time(const RunResult& run) {
  return run.cpu_s;
}
double evaluations(const RunResult& run) {
  return static_cast<double>(run.counters.evaluations);
}
double position_error(const RunResult& run) {
  return run.position_error_max;
}
double position_drift(const RunResult& run) {
  return run.position_drift_max;
}
double energy_error(const RunResult& run) {
  return run.energy_error_max;
}

/// Joins the rungs of a ladder; runs of a drift study stand alone.
Chart scatter(const StudyResult& study, const Cost& cost, const std::vector<Sign>& signs) {
  Chart chart;
  chart.key = cost.key;
  chart.title = cost.title;
  chart.x_title = cost.x_title;
  chart.y_title = cost.y_title;
  chart.unit = cost.unit;
  chart.log_x = chart.log_y = true;
  const auto labels = run_labels(study, study.drift_study);
  const auto ladder = ladders(study);
  std::map<std::size_t, std::size_t> place;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const RunResult& run = study.runs[i];
    const double x = cost.x(run), y = cost.y(run);
    if (!(x > 0) || !std::isfinite(y)) continue;
    const std::size_t group = study.drift_study ? i : ladder[i];
    if (place.emplace(group, chart.curves.size()).second) {
      chart.curves.push_back({labels[group], {}, {}, signs[group]});
      chart.curves.back().dots = true;
    }
    Curve& curve = chart.curves[place[group]];
    curve.x.push_back(x);
    curve.y.push_back(std::max(y, rounding_floor));
    curve.failed = !finished(run);
  }
  return chart;
}

}  // namespace

std::vector<Chart> charts_of_study(const StudyResult& study) {
  const auto signs = signs_of(study);
  const auto labels = run_labels(study), ladder_labels = run_labels(study, false);
  std::vector<Chart> charts;
  if (study.runs.empty()) return charts;
  for (const History& history : histories(study.runs.front())) {
    Chart chart = over_time(history.key, history.title, history.axis, history.unit);
    chart.log_x = chart.log_y = chart.running_maximum = true;
    chart.slopes = history.slopes;
    for (const std::size_t i : runs_with_curves(study)) {
      const RunResult& run = study.runs[i];
      const std::vector<double>& y = run.series.*history.values;
      if (!any_finite(y)) continue;
      // |λ| is a force and |σ| an impulse: only forms with impulses share the axis.
      if (std::string(history.key) == "impulse" && !takes_gauge(run.settings.form)) continue;
      chart.curves.push_back({study.drift_study ? labels[i] : ladder_labels[i], run.series.t,
                              sizes_of(y), signs[i], !finished(run)});
    }
    if (!chart.curves.empty()) charts.push_back(std::move(chart));
  }
  const bool judged = std::any_of(study.runs.begin(), study.runs.end(), [](const RunResult& run) {
    return std::isfinite(run.position_error_max);
  });
  const char* time = "processor time [s]";
  const std::string drift_in = drift_unit(study.runs.front());
  const std::string drift = "largest position drift |Φ| [" + drift_in + "]";
  const std::string error = judged ? "error of positions max |err|/(1+|ref|)" : drift;
  const std::string unit = judged ? "1" : drift_in;
  const auto y = judged ? position_error : position_drift;
  std::vector<Cost> costs{
      {"error_cost", "Error against processor time", time, error, unit, processor_time, y}};
  if (!study.drift_study) {
    costs.push_back({"error_evaluations", "Error against evaluations",
                     "evaluations of right-hand side or residual", error, unit, evaluations, y});
    costs.push_back({"drift_cost", "Position drift against processor time", time, drift, drift_in,
                     processor_time, position_drift});
    costs.push_back({"energy_cost", "Energy error against processor time", time,
                     "largest energy error |E − E₀| [J]", "J", processor_time, energy_error});
  }
  for (const Cost& cost : costs) {
    Chart chart = scatter(study, cost, signs);
    if (!chart.curves.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace momenta
