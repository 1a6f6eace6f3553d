#pragma once
// What `momenta sweep` prints and writes. Columns of the CSV and keys of the JSON are public
// interface.

#include <momenta/dae/study/sweep_statistics.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// One row per case in the order of their numbers: case, the varied numbers, status, stopped_at,
/// drifts, energy error, steps, evaluations, last, least and greatest of each watched column, and
/// the reason. No times: the same study gives the same text on any number of threads or processes.
std::string sweep_csv(const SweepRequest&, const std::vector<SweepCase>&);

/// How many cases ended how, the extremes of every measure and where they are, and processor time;
/// with
/// `statistics`, those of a sample, what sample_report.h says.
nlohmann::ordered_json sweep_json(const SweepRequest&, const std::vector<SweepCase>&,
                                  const SweepStatistics* statistics = nullptr);

/// The same in words and, of few cases, every one in a line.
std::string sweep_table(const SweepRequest&, const std::vector<SweepCase>&,
                        const SweepStatistics* statistics = nullptr);

}  // namespace momenta
