#pragma once
// A suite: files of equations, each run by methods at tolerances, and scored against references.
//
//   name = "…"
//   methods = ["ida", "radau5"]
//   tolerances = [1e-4, 1e-6, 1e-8]
//   [[problem]]
//   file = "akzo_nobel.toml"       # from the suite's folder; its own methods and tolerances may
//                                  # stand beside it

#include <momenta/dae/analysis/equations/equation_run.h>
#include <momenta/dae/analysis/equations/quad_reference.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace momenta {

struct SuiteProblem {
  std::string file;                  ///< path to open
  std::vector<std::string> methods;  ///< ida, radau5
  std::vector<double> tolerances;    ///< rtol = atol, as they are written
};
struct Suite {
  std::string file, name;
  std::vector<SuiteProblem> problems;
};

/// @throws SceneError
Suite read_suite(const std::filesystem::path& file);

/// One problem with its reference and its runs.
struct ProblemResult {
  std::string file, name, why;  ///< why: one sentence where there are no runs
  int unknowns = 0, index = -1, structural_index = -1;
  double t = 0;  ///< time of the reference
  std::vector<std::string> variables;
  std::vector<std::string> reference;  ///< decimals by variable, empty: not given
  bool own_reference = false;          ///< made here, in quadruple precision
  double accuracy = 0;                 ///< own reference: distance of two tolerances
  std::vector<EquationRun> runs;
  std::vector<Digits> digits;  ///< by run
};
struct SuiteResult {
  std::string name;
  std::vector<ProblemResult> problems;
  bool complete = true;  ///< not interrupted
};

struct SuiteRequest {
  enum class Timing { none, once, rounds };
  Timing timing = Timing::rounds;  ///< rounds: least time of repeats of short runs
  bool own_references = false;     ///< made even if the file has one
  double max_cpu_seconds = 60;
  /// Called before each run (number, of how many, label); false ends the suite. May be empty.
  std::function<bool(int, int, const std::string&)> progress;
};

/// The runs of one problem. `going_on` takes a label of the next run; false stops. @throws
/// SceneError where an equation is not finite at the guess, std::runtime_error without a consistent
/// start or a reference
ProblemResult run_problem(const EquationFile& file, const SuiteProblem& problem,
                          const SuiteRequest& request,
                          const std::function<bool(const std::string&)>& going_on);

/// A problem that fails says so in its `why`; the others run.
SuiteResult run_suite(const Suite& suite, const SuiteRequest& request);

}  // namespace momenta
