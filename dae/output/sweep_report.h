#pragma once
// Output of `momenta sweep`. Columns of the CSV and keys of the JSON are public interface.

#include <momenta/dae/study/sweep_statistics.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// One row a case by number: case, the varied numbers, status, stopped_at, drifts, energy error,
/// steps, evaluations, last, least and greatest of each watched column, and the reason. No times:
/// the text is the same on any number of threads or processes.
std::string sweep_csv(const SweepRequest&, const std::vector<SweepCase>&);

/// Cases by end, extremes of every measure and their cases, processor time; `statistics` of a
/// sample add the keys of sample_report.h.
nlohmann::ordered_json sweep_json(const SweepRequest&, const std::vector<SweepCase>&,
                                  const SweepStatistics* statistics = nullptr);

/// Words, with a line for each of few cases.
std::string sweep_table(const SweepRequest&, const std::vector<SweepCase>&,
                        const SweepStatistics* statistics = nullptr);

}  // namespace momenta
