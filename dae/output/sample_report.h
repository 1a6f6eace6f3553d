#pragma once
// Output of `momenta sweep --sample` beside the rows of cases: statistics, indices, curves. Columns
// of the CSV and keys of the JSON are public interface.

#include <momenta/dae/study/sweep_statistics.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// statistics.csv, one row a quantity: quantity, count, mean, deviation, least, q05 … q95,
/// greatest; with indices also, for each varied place, PLACE first, PLACE first error, PLACE total,
/// PLACE total error.
std::string statistics_csv(const SweepRequest&, const SweepStatistics&);

/// curves.csv, one row a time: t, and for each watched column mean, deviation, q05 … q95.
std::string curves_csv(const SweepStatistics&);

/// Additions to sweep.json: {sampling{…}, statistics{quantity: {…, indices{place: {…}}}},
/// along_time{column: {…}}}.
nlohmann::ordered_json sample_json(const SweepRequest&, const SweepStatistics&);

/// The sampling in words, and tables of statistics and indices.
std::string sample_table(const SweepRequest&, const SweepStatistics&);

/// A page without script: tables, and a chart of each watched column with quantiles.
std::string sample_page(const SweepRequest&, const SweepStatistics&, const std::vector<SweepCase>&,
                        const Environment&, const std::string& command);

}  // namespace momenta
