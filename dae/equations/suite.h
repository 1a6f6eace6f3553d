#pragma once
// A suite: files of equations, each run by methods at tolerances, and scored against references.
//
//   name = "…"
//   methods = ["ida", "radau5"]
//   tolerances = [1e-4, 1e-6, 1e-8]
//   [[problem]]
//   file = "akzo_nobel.toml"       # from the suite's folder; its own methods and tolerances may
//                                  # stand beside it

#include <momenta/dae/equations/equation_run.h>
#include <momenta/dae/equations/quad_reference.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace momenta {

struct SuiteProblem {
  std::string file;                  ///< as it is to be opened
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
  double t = 0;  ///< of the reference
  std::vector<std::string> variables;
  std::vector<std::string> reference;  ///< digits of each variable, empty: not given
  bool own_reference = false;          ///< made here, in quadruple precision
  double accuracy = 0;                 ///< of an own one: distance of two tolerances
  std::vector<EquationRun> runs;
  std::vector<Digits> digits;  ///< of each run
};
struct SuiteResult {
  std::string name;
  std::vector<ProblemResult> problems;
  bool complete = true;  ///< not interrupted
};

struct SuiteRequest {
  enum class Timing { none, once, rounds };
  Timing timing = Timing::rounds;  ///< rounds: short runs are repeated, their least time is taken
  bool own_references = false;     ///< made anew also where a file has one
  double max_cpu_seconds = 60;
  /// Before each run (number, of how many, label); false ends the suite. May be empty.
  std::function<bool(int, int, const std::string&)> progress;
};

/// The runs of one problem. `going_on` is told what comes next; false ends it. @throws SceneError
/// where there is no consistent start, std::runtime_error where no reference can be made
ProblemResult run_problem(const EquationFile& file, const SuiteProblem& problem,
                          const SuiteRequest& request,
                          const std::function<bool(const std::string&)>& going_on);

/// What cannot be run is told in its row; nothing of one problem keeps the others from running.
SuiteResult run_suite(const Suite& suite, const SuiteRequest& request);

}  // namespace momenta
