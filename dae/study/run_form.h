#pragma once
// One run: a form, an integrator, and everything measured on the way.

#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/measure/reference.h>
#include <momenta/dae/study/run_result.h>

#include <functional>

namespace momenta {

/// A run between two of its steps.
struct Checkpoint {
  double t = 0;                ///< [s]
  std::vector<double> memory;  ///< what integrator, form and measures carry
  /// What was measured until then, but the rows of the trajectory: these are the caller's.
  RunResult so_far;
};

/// One run: what to do, what to keep, whom to tell.
struct RunRequest {
  RunSettings settings;                  ///< form, integrator, tolerances, times
  const Reference* reference = nullptr;  ///< bound to trajectory_columns(mechanism)
  bool keep_trajectory = false;          ///< RunResult::trajectory is filled
  int keep_every = 1;                    ///< of its rows, from the first
  /// Called with every row of the trajectory, where one is kept; return false to stop the run.
  std::function<bool(const std::vector<double>& row)> on_row;
  /// The film has the start and this many equal intervals more; a run that fails, fewer. 0: none.
  int film_intervals = 0;
  double max_cpu_seconds = 0;  ///< 0: none
  /// Called with the time of each sample; return false to stop the run.
  std::function<bool(double t)> progress;
  /// Asked after each step; false stops the run.
  std::function<bool()> going_on;
  /// Called between steps of a run that can go on from there in another process, to the last bit:
  /// one by an explicit Runge-Kutta method, unless its form or solver carries what is no list of
  /// numbers (`partitioned`; KLU). `make`, or not.
  std::function<void(const std::function<Checkpoint()>& make)> between_steps;
  /// Where the run goes on, of the same mechanism, start, settings, reference and program; null:
  /// from the start.
  const Checkpoint* from = nullptr;
};

/// Columns of trajectory.csv: t, q, u, markers, energy, drifts, loop forces.
std::vector<std::string> trajectory_columns(const Mechanism& mechanism);

/// Runs once, every sample looked at. Failures are in the result: status, reason and all samples up
/// to there; cpu_s is that of the watched run. @throws std::invalid_argument for settings that are
/// no numbers or do not fit together, and for a start of wrong size or that is none.
RunResult run_form(const Mechanism& mechanism, const Start& start, const RunRequest& request);

/// The sentence for a run past an ambiguous singular pose.
std::string ambiguous_from(double t);

/// A run with nobody looking, and what it costs.
struct TimedRun {
  double cpu_s = not_measured;   ///< of the integration alone
  double wall_s = not_measured;  ///< likewise
  Counters counters;             ///< without what looking on takes
};
/// `settings`: those of a run that is done. `at_step` is asked after each step; false ends it.
TimedRun time_run(const Mechanism& mechanism, const Start& start, RunSettings settings,
                  const std::function<bool()>& at_step = {});

/// The integrator a form takes when none is named: for DAE forms ida, else that of the order which
/// costs least at such tolerances: dp5 from 1e-4 up, vern9 from 1e-9 down, dop853 between.
std::string default_integrator(const std::string& form, double rtol);

/// A run of this form where nothing else is said: tolerances both `rtol`, times, step, gauge and
/// correction of the scene, and the default integrator where `method` is empty. @throws
/// std::invalid_argument for an integrator there is not.
RunSettings default_settings(const RunDefaults& scene, const std::string& form,
                             const std::string& method, double rtol);

}  // namespace momenta
