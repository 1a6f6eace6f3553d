#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/text/csv_cells.h>
#include <momenta/dae/run/measure/reference.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

namespace momenta {
namespace {

std::string unit_of(const std::string& column) {
  const auto open = column.rfind('['), close = column.rfind(']');
  return open == std::string::npos || close == std::string::npos || close < open
             ? ""
             : column.substr(open + 1, close - open - 1);
}

Reference::Kind kind_of(const std::string& column) {
  using Kind = Reference::Kind;
  const auto named = [&](const char* part) { return column.find(part) != std::string::npos; };
  const std::string unit = unit_of(column);
  if (unit == "N" || unit == "N m")
    return named(".effort")                        ? Kind::effort
           : named(".force_") || named(".torque_") ? Kind::reaction
                                                   : Kind::force;
  if (named(".impulse")) return Kind::impulse;
  if (unit == "N s" || unit == "N m s" || unit.starts_with("J s/")) return Kind::momentum;
  if (column == "work [J]") return Kind::work;
  return unit.ends_with("/s") ? Kind::velocity : Kind::position;
}

}  // namespace

Reference::Reference(const std::filesystem::path& file) : file_(file.string()) {
  reading::expect_plain_file(file, "reference solution in CSV");
  std::ifstream in(file);
  if (!in) throw SceneError(file_ + ": cannot be read; expected a reference solution in CSV");
  std::string line;
  int number = 1;
  const auto refuse = [&](const std::string& what) {
    throw SceneError(file_ + ":" + std::to_string(number) + ": " + what);
  };
  if (!std::getline(in, line))
    refuse("the file is empty; expected a header row starting with t [s]");
  columns_ = csv_cells(line);
  if (columns_.front() != "t [s]")
    refuse("found '" + columns_.front().substr(0, 40) + "' as first column; expected t [s]");
  for (const auto& column : columns_)
    if (unit_of(column).empty())
      refuse("column '" + column.substr(0, 40) + "' has no unit; expected name [unit]");
  columns_.erase(columns_.begin());
  while (std::getline(in, line)) {
    ++number;
    if (line.empty() || line == "\r") continue;
    const auto cells = csv_cells(line);
    if (cells.size() != columns_.size() + 1)
      refuse("found " + std::to_string(cells.size()) + " cells; expected " +
             std::to_string(columns_.size() + 1));
    std::vector<double> row;
    for (const auto& cell : cells) {
      double value = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      // Numbers below the smallest double count as zero.
      if (error == std::errc::result_out_of_range && cell.find("e-") != std::string::npos)
        value = 0;
      else if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
        refuse("found '" + cell.substr(0, 40) + "'; expected a finite number");
      row.push_back(value);
    }
    if (!times_.empty() && !(row.front() > times_.back()))
      refuse("time does not increase; expected a later time than that of the line before");
    times_.push_back(row.front());
    row.erase(row.begin());
    values_.push_back(std::move(row));
  }
  if (times_.empty()) refuse("there are no rows; expected at least one time");
}

std::string Reference::csv() const {
  std::string text = "t [s]";
  for (const std::string& column : columns_) text += "," + column;
  text += '\n';
  const auto add = [&text](double x) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
  };
  for (std::size_t i = 0; i < times_.size(); ++i) {
    add(times_[i]);
    for (const double x : values_[i]) {
      text += ',';
      add(x);
    }
    text += '\n';
  }
  return text;
}

void Reference::bind(const std::vector<std::string>& measured_columns) {
  place_.clear();
  kind_.clear();
  for (const auto& column : columns_) {
    const auto found = std::find(measured_columns.begin(), measured_columns.end(), column);
    if (found == measured_columns.end())
      throw SceneError(file_ + ":1: column '" + column +
                       "' is not one of the trajectory's; expected for instance '" +
                       (measured_columns.size() > 1 ? measured_columns[1] : "") + "'");
    place_.push_back(static_cast<std::size_t>(found - measured_columns.begin()));
    kind_.push_back(kind_of(column));
  }
}

bool Reference::has(Kind kind) const {
  return std::find(kind_.begin(), kind_.end(), kind) != kind_.end();
}

std::size_t Reference::column_at(std::size_t place) const {
  return static_cast<std::size_t>(std::find(place_.begin(), place_.end(), place) - place_.begin());
}

Reference::Error Reference::error(std::size_t row, const std::vector<double>& measured,
                                  const std::vector<std::size_t>& not_unique) const {
  Error e;
  const auto of = [&e](Kind kind) -> double& {
    return kind == Kind::velocity   ? e.velocity
           : kind == Kind::force    ? e.force
           : kind == Kind::effort   ? e.effort
           : kind == Kind::reaction ? e.reaction
           : kind == Kind::impulse  ? e.impulse
           : kind == Kind::work     ? e.work
                                    : e.position;
  };
  std::array<bool, 8> met{true, true};  // positions and velocities start at 0
  for (std::size_t i = 0; i < place_.size(); ++i) {
    if (kind_[i] == Kind::momentum) continue;
    if (std::binary_search(not_unique.begin(), not_unique.end(), place_[i])) continue;
    const double reference = values_[row][i];
    const double difference = std::abs(measured[place_[i]] - reference) / (1 + std::abs(reference));
    double& largest = of(kind_[i]);
    bool& any = met[static_cast<std::size_t>(kind_[i])];
    // NaN stays.
    if (!any || (!std::isnan(largest) && !(difference <= largest))) largest = difference;
    any = true;
  }
  return e;
}

}  // namespace momenta
