#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/run/run_quantities.h>

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
  struct Cell {
    std::string operator()(const std::string& text) const { return csv_cell(text); }
    std::string operator()(double x) const { return round_trip(x); }
    std::string operator()(long n) const { return std::to_string(n); }
    std::string operator()(bool yes) const { return yes ? "true" : "false"; }
  };
  const std::string unit = study.runs.empty() ? "m" : drift_unit(study.runs.front());
  std::vector<std::string> head;
  for (const RunQuantity& quantity : run_quantities())
    if (quantity.column) head.push_back(quantity.heading(unit));
  std::string text = csv_line(head);
  for (const RunResult& run : study.runs) {
    std::vector<std::string> cells;
    for (const RunQuantity& quantity : run_quantities())
      if (quantity.column) cells.push_back(std::visit(Cell(), quantity.value(run)));
    text += csv_line(cells);
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
