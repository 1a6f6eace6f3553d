#pragma once
// Results as CSV (RFC 4180 quoting, lines end in LF): header `name [unit]`, round-trip digits, an
// empty cell where nothing was measured.

#include <momenta/dae/study/run_result.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// One row per run: settings, status, drift, energy, error, counters, times.
std::string study_csv(const StudyResult&);

/// The lines of trajectory.csv: its header from the columns, and one of an output time.
std::string trajectory_head(const std::vector<std::string>& columns);
std::string trajectory_line(const std::vector<double>& row);
/// The rows below the header of a text of such lines, bit for bit. False where one is not whole.
bool read_trajectory_rows(std::string_view text, std::size_t columns,
                          std::vector<std::vector<double>>& rows);

/// events.csv: t, name, direction, and the columns of the trajectory there.
std::string events_csv(const RunResult& run);

/// The text as one cell: quoted when it holds a comma, a quote or a line break, its quotes doubled.
std::string csv_cell(std::string_view text);
/// Cells with commas between and a line break behind.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace momenta
