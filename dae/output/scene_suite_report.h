#pragma once
// Report on a suite of mechanisms: a row for each run, as text, CSV, JSON and a page. Keys and
// columns are public interface.

#include <momenta/dae/run/run_result.h>
#include <momenta/dae/study/scene_suite.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// A row a run: error, drifts, energy, work; then references, and the cheapest run within each
/// error bound of a source.
std::string suite_table(const SceneSuiteResult&);
std::string suite_csv(const SceneSuiteResult&);
nlohmann::ordered_json suite_json(const SceneSuiteResult&, const Environment&);
/// Error against evaluations by problem, and the table. Without script.
std::string suite_page(const SceneSuiteResult&, const Environment&, const std::string& command);

}  // namespace momenta
