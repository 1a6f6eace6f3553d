#pragma once
// A suite of mechanisms: scenes, each run in forms by integrators at tolerances, and judged by the
// error that its source defines.
//
//   name = "…"
//   forms = ["momentum", "projected"]
//   tolerances = [1e-4, 1e-6]
//   [[problem]]
//   scene = "pendulum.toml"        # from the suite's folder
//   reference = "pendulum.csv"     # without: made here, in quadruple precision
//   error = "threshold"            # measure/benchmark_error.h
//   threshold = 1e-3
//   allowed = [1e-1, 1e-3]         # errors that the source accepts
//
// A suite of files of equations, dae/analysis/equations/suite.h, is another kind: its problems have
// a `file`.

#include <momenta/core/format/toml/setting.h>
#include <momenta/dae/run/measure/benchmark_error.h>
#include <momenta/dae/study/work_study.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

struct SceneProblem {
  std::string scene, name;           ///< path to open; empty name: the scene's
  std::vector<Setting> set;          ///< other numbers for the scene
  std::string reference;             ///< CSV to open; empty: made in quadruple precision
  std::optional<double> end;         ///< [s]; none: the reference's, or the scene's
  int samples = 100;                 ///< output intervals, where no file of a reference has its own
  std::vector<std::string> columns;  ///< judged ones; empty: all of the reference but forces
  BenchmarkError::Kind error = BenchmarkError::Kind::mixed;
  double threshold = 1e-3;      ///< for Kind::threshold
  std::vector<double> allowed;  ///< errors that the source accepts, falling
  std::vector<std::string> forms, integrators;
  std::vector<double> tolerances;  ///< rtol = atol
};
struct SceneSuite {
  std::string file, name;
  std::vector<SceneProblem> problems;
};

/// Whether the problems of a suite are scenes; false for no suite.
bool has_scenes(const std::filesystem::path& suite);

/// @throws SceneError
SceneSuite read_scene_suite(const std::filesystem::path& file);

struct SceneProblemResult {
  std::string scene, name, why;  ///< why: one sentence where there are no runs
  std::vector<Setting> set;      ///< numbers that the suite sets in the scene
  int coordinates = 0, equations = 0;
  double end = 0;  ///< [s]
  int samples = 0;
  BenchmarkError::Kind error = BenchmarkError::Kind::mixed;
  double threshold = 0;
  std::vector<double> allowed;
  std::string reference;             ///< the file, or how it was made
  std::vector<std::string> columns;  ///< judged
  std::vector<RunResult> runs;
  std::vector<double> errors;  ///< by run; NaN: not done
};
struct SceneSuiteResult {
  std::string name;
  std::vector<SceneProblemResult> problems;
  bool complete = true;  ///< not interrupted
};

struct SceneSuiteRequest {
  Timing timing = Timing::rounds;
  bool own_references = false;  ///< made even if a problem has a file
  double max_cpu_seconds = 60;  ///< per run
  /// Called before and during each run (problem, of how many, label); false ends the suite.
  std::function<bool(int, int, const std::string&)> progress;
};

/// Error of a run with a trajectory against a reference at the same times; NaN unless done. @throws
/// SceneError for other times
double error_of(const RunResult& run, const Reference& reference,
                const std::vector<std::string>& columns, BenchmarkError error);

/// A problem that fails says so in its `why`; the others run.
SceneSuiteResult run_suite(const SceneSuite& suite, const SceneSuiteRequest& request);

/// Run that meets an error with the fewest evaluations; none: errors.size().
std::size_t cheapest_within(const SceneProblemResult& problem, double allowed);

}  // namespace momenta
