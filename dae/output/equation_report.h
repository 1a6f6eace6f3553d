#pragma once
// Reports on files of equations: their index, a run, a suite; as text for the terminal, JSON and
// CSV. Keys and columns are public interface.

#include <momenta/dae/analysis/equations/suite.h>
#include <momenta/dae/run/run_result.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Both indices, why they differ, offsets of equations and variables; changes of the start.
std::string equation_index_table(const EquationFile&, const EquationStart&);
nlohmann::ordered_json equation_index_json(const EquationFile&, const EquationStart&);

/// "x 1 → 0.98, y 0 → 0.2"; empty: no change.
std::string moved_in_words(const EquationFile&, const EquationStart&);

std::string equation_run_table(const EquationFile&, const EquationStart&, const EquationRun&,
                               const Digits&);
nlohmann::ordered_json equation_run_json(const EquationFile&, const EquationStart&,
                                         const EquationRun&, const Digits&, const Environment&);
/// Method, tolerances, status, counters, digits of a run.
nlohmann::ordered_json equation_run_json(const EquationRun&, const Digits&);
/// t and all variables, one row an output time.
std::string equation_trajectory(const EquationFile&, const EquationRun&);

/// A row a run: digits, steps, evaluations, time.
std::string suite_table(const SuiteResult&);
std::string suite_csv(const SuiteResult&);
nlohmann::ordered_json suite_json(const SuiteResult&, const Environment&);

/// index.html without script: curves of a run; digits of a suite against steps and time, and its
/// table.
std::string equation_run_page(const EquationFile&, const EquationStart&, const EquationRun&,
                              const Digits&, const Environment&, const std::string& command);
std::string suite_page(const SuiteResult&, const Environment&, const std::string& command);

}  // namespace momenta
