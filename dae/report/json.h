#pragma once
// Results as JSON: summary.json of one run, and the array of a study. Keys are public interface.

#include <momenta/dae/study/run_result.h>

#include <nlohmann/json.hpp>

namespace momenta {

/// summary.json: scene form integrator gauge rtol atol step end_time status reason stopped_at
/// project jacobian linear_solver kkt counters{…} time{…} drift{…} energy{…} error{…}
/// environment{…}. Missing measurements are null.
nlohmann::ordered_json summary_json(const RunResult&, const Environment&);

nlohmann::ordered_json study_json(const StudyResult&);

/// null unless finite: JSON has no NaN.
nlohmann::ordered_json number_or_null(double);

/// {cpu compiler flags build_type date versions{name: version}}.
nlohmann::ordered_json environment_json(const Environment&);

}  // namespace momenta
