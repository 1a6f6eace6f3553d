#pragma once
// Results as CSV (RFC 4180 quoting, lines end in LF): header `name [unit]`, round-trip digits,
// empty cells for missing measurements.

#include <momenta/dae/run/run_result.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// One row a run: settings, status, drift, energy, error, counters, times.
std::string study_csv(const StudyResult&);

/// Lines of trajectory.csv: the header, and one for an output time.
std::string trajectory_head(const std::vector<std::string>& columns);
std::string trajectory_line(const std::vector<double>& row);
/// Rows below the header, bit for bit. False where a line is not whole.
bool read_trajectory_rows(std::string_view text, std::size_t columns,
                          std::vector<std::vector<double>>& rows);

/// events.csv: t, name, direction, columns of the trajectory.
std::string events_csv(const RunResult& run);

/// Quoted if it holds a comma, a quote or a line break, its quotes doubled.
std::string csv_cell(std::string_view text);
/// Cells with commas between and a line break at the end.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace momenta
