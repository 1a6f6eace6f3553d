#pragma once
// What `momenta sweep --sample` tells beside the rows of its cases: statistics, indices, curves.
// Columns of the CSV and keys of the JSON are public interface.

#include <momenta/dae/study/sweep_statistics.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// statistics.csv, one row a quantity: quantity, count, mean, deviation, least, q05 … q95,
/// greatest; with indices also, of each varied place, PLACE first, PLACE first error, PLACE total,
/// PLACE total error.
std::string statistics_csv(const SweepRequest&, const SweepStatistics&);

/// curves.csv, one row a time: t, and of each watched column mean, deviation, q05 … q95.
std::string curves_csv(const SweepStatistics&);

/// {sampling{…}, statistics{quantity: {…, indices{place: {…}}}}, along_time{column: {…}}}: what
/// sweep.json has beside what it has of combinations.
nlohmann::ordered_json sample_json(const SweepRequest&, const SweepStatistics&);

/// How was sampled, a table of statistics and one of indices, in words.
std::string sample_table(const SweepRequest&, const SweepStatistics&);

/// A page without script: the tables, and a chart of each watched column with its quantiles.
std::string sample_page(const SweepRequest&, const SweepStatistics&, const std::vector<SweepCase>&,
                        const Environment&, const std::string& command);

}  // namespace momenta
