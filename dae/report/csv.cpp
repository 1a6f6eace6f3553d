#include <momenta/dae/report/csv.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace momenta {
std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    line += cells[i];
  }
  return line + "\n";
}

std::string study_csv(const StudyResult& study) {
  const std::string unit = study.runs.empty() ? "m" : drift_unit(study.runs.front());
  std::string text = csv_line({"scene",
                               "form",
                               "integrator",
                               "gauge",
                               "rtol",
                               "atol",
                               "step [s]",
                               "end_time [s]",
                               "project",
                               "baumgarte_alpha [1/s]",
                               "baumgarte_beta [1/s]",
                               "beta [1/s]",
                               "penalty",
                               "kkt",
                               "jacobian",
                               "linear_solver",
                               "status",
                               "stopped_at [s]",
                               "reason",
                               "position_drift_max [" + unit + "]",
                               "velocity_drift_max [" + unit + "/s]",
                               "between_steps_max [" + unit + "]",
                               "angle_drift_max [rad]",
                               "angle_rate_drift_max [rad/s]",
                               "angle_between_steps_max [rad]",
                               "position_exponent",
                               "position_exponent_half_range",
                               "velocity_exponent",
                               "velocity_exponent_half_range",
                               "angle_exponent",
                               "angle_exponent_half_range",
                               "angle_rate_exponent",
                               "angle_rate_exponent_half_range",
                               "energy_error_max [J]",
                               "position_error_max",
                               "velocity_error_max",
                               "force_error_max",
                               "multiplier_error_max",
                               "multiplier_difference_max",
                               "momentum_error_max",
                               "impulse_error_max",
                               "effort_error_max",
                               "reaction_error_max",
                               "work_error_max",
                               "steps",
                               "rejected",
                               "evaluations",
                               "jacobians",
                               "factorizations",
                               "newton_iterations",
                               "partitions",
                               "cpu [s]",
                               "wall [s]",
                               "repeats"});
  for (const RunResult& run : study.runs) {
    const RunSettings& s = run.settings;
    const Counters& c = run.counters;
    text += csv_line({csv_cell(run.scene),
                      csv_cell(s.form),
                      csv_cell(s.integrator),
                      csv_cell(s.gauge),
                      round_trip(s.rtol),
                      round_trip(s.atol),
                      round_trip(s.step),
                      round_trip(s.end_time),
                      s.project ? "true" : "false",
                      round_trip(s.baumgarte_alpha),
                      round_trip(s.baumgarte_beta),
                      round_trip(s.beta),
                      round_trip(s.penalty),
                      csv_cell(s.kkt),
                      csv_cell(run.jacobian),
                      csv_cell(run.linear_solver),
                      csv_cell(run.status),
                      round_trip(run.stopped_at),
                      csv_cell(run.reason),
                      round_trip(run.position_drift_max),
                      round_trip(run.velocity_drift_max),
                      round_trip(run.between_steps_max),
                      round_trip(run.angle_drift_max),
                      round_trip(run.angle_rate_drift_max),
                      round_trip(run.angle_between_steps_max),
                      round_trip(run.position_growth.exponent),
                      round_trip(run.position_growth.half_range),
                      round_trip(run.velocity_growth.exponent),
                      round_trip(run.velocity_growth.half_range),
                      round_trip(run.angle_growth.exponent),
                      round_trip(run.angle_growth.half_range),
                      round_trip(run.angle_rate_growth.exponent),
                      round_trip(run.angle_rate_growth.half_range),
                      round_trip(run.energy_error_max),
                      round_trip(run.position_error_max),
                      round_trip(run.velocity_error_max),
                      round_trip(run.force_error_max),
                      round_trip(run.multiplier_error_max),
                      round_trip(run.multiplier_difference_max),
                      round_trip(run.momentum_error_max),
                      round_trip(run.impulse_error_max),
                      round_trip(run.effort_error_max),
                      round_trip(run.reaction_error_max),
                      round_trip(run.work_error_max),
                      std::to_string(c.steps),
                      std::to_string(c.rejected),
                      std::to_string(c.evaluations),
                      std::to_string(c.jacobians),
                      std::to_string(c.factorizations),
                      std::to_string(c.newton_iterations),
                      std::to_string(run.partitions),
                      round_trip(run.cpu_s),
                      round_trip(run.wall_s),
                      std::to_string(run.repeats)});
  }
  return text;
}

std::string trajectory_head(const std::vector<std::string>& columns) {
  std::vector<std::string> cells;
  for (const std::string& column : columns) cells.push_back(csv_cell(column));
  return csv_line(cells);
}

std::string events_csv(const RunResult& run) {
  const std::vector<std::string>& columns = run.trajectory.columns;
  std::vector<std::string> head{"t [s]", "event", "direction"};
  for (std::size_t i = 1; i < columns.size(); ++i) head.push_back(csv_cell(columns[i]));
  std::string text = csv_line(head);
  for (const FoundEvent& e : run.events) {
    std::vector<std::string> cells{round_trip(e.t), csv_cell(e.name), e.up ? "up" : "down"};
    for (std::size_t i = 1; i < columns.size(); ++i)
      cells.push_back(i < e.row.size() ? round_trip(e.row[i]) : "");
    text += csv_line(cells);
  }
  return text;
}

bool read_trajectory_rows(std::string_view text, std::size_t columns,
                          std::vector<std::vector<double>>& rows) {
  rows.clear();
  for (std::size_t at = text.find('\n') + 1, end = 0; at < text.size(); at = end + 1) {
    end = text.find('\n', at);
    if (end == std::string_view::npos) return false;
    std::vector<double>& row = rows.emplace_back();
    for (std::size_t cell = at; cell <= end;) {
      const std::size_t stop = std::min(text.find(',', cell), end);
      double value = not_measured;
      const auto read = std::from_chars(text.data() + cell, text.data() + stop, value);
      if (cell < stop && (read.ec != std::errc() || read.ptr != text.data() + stop)) return false;
      row.push_back(value);
      cell = stop + 1;
    }
    if (row.size() != columns) return false;
  }
  return true;
}

std::string trajectory_line(const std::vector<double>& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line += ',';
    line += round_trip(row[i]);
  }
  return line + "\n";
}

}  // namespace momenta
