#pragma once
// One run: a form, an integrator, and everything measured on the way.

#include <momenta/dae/assembly.h>
#include <momenta/dae/measure/reference.h>
#include <momenta/dae/study/run_result.h>

#include <functional>

namespace momenta {

struct RunRequest {
  RunSettings settings;
  const Reference* reference = nullptr;  ///< bound to trajectory_columns(mechanism)
  bool keep_trajectory = false;
  int repeats = 3;             ///< timed runs after the measured one; 0: time the measured one
  double repeat_budget = 3;    ///< [s]: no further repeat once this much CPU time is spent
  double max_cpu_seconds = 0;  ///< 0: none
  /// Called now and then with the simulated time; return false to stop the run.
  std::function<bool(double t)> progress;
};

/// Columns of trajectory.csv: t, q, u, markers, energy, drifts, loop forces.
std::vector<std::string> trajectory_columns(const Mechanism& mechanism);

/// Runs once with every sample looked at, then `repeats` times with nobody looking, for the CPU
/// time. Failures are in the result: status, reason and all samples up to there. @throws
/// std::invalid_argument for settings that don't fit.
RunResult run_form(const Mechanism& mechanism, const Start& start, const RunRequest& request);

/// The integrator a form takes when none is named: dop853, or ida for DAE forms.
std::string default_integrator(const std::string& form);

}  // namespace momenta
