#pragma once
// A run: a form, an integrator, and everything measured during the integration.

#include <momenta/dae/run/measure/reference.h>
#include <momenta/dae/run/run_result.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <functional>

namespace momenta {

class IntegratedScene;  // dae/topology/cut/integrated_scene.h

/// State of a run between two steps, from which it can continue.
struct Checkpoint {
  double t = 0;                ///< [s]
  std::vector<double> memory;  ///< memory of integrator, form and measures
  /// Measures so far, without the trajectory's rows, which the caller keeps.
  RunResult so_far;
};

/// Request for one run: settings, what it keeps, functions it calls.
struct RunRequest {
  RunSettings settings;  ///< form, integrator, tolerances, times
  /// Scene to integrate, made of the same mechanism and start; null: chosen for this run.
  const IntegratedScene* integrated = nullptr;
  /// Reference bound to trajectory_columns(mechanism), with or without reactions.
  const Reference* reference = nullptr;
  bool keep_trajectory = false;  ///< RunResult::trajectory is filled
  /// Measures RunResult::multiplier_difference_max; a reference with forces implies it.
  bool multipliers = false;
  bool events = false;     ///< finds the scene's events, which may end the run
  bool reactions = false;  ///< adds the reactions of joints to the columns
  int keep_every = 1;      ///< keep every n-th row, from the first
  /// Called with every row of a kept trajectory; false stops the run.
  std::function<bool(const std::vector<double>& row)> on_row;
  /// Equal intervals of the film; a failed run has fewer. 0: no film.
  int film_intervals = 0;
  double max_cpu_seconds = 0;  ///< 0: none
  /// Called with the time of each sample; false stops the run.
  std::function<bool(double t)> progress;
  /// Called after each step; false stops the run.
  std::function<bool()> going_on;
  /// Called between steps of a run that another process can continue from there, to the last bit: a
  /// run by an explicit Runge-Kutta method, unless its form or solver carries more than a list of
  /// numbers (`partitioned`; KLU). `make` makes the checkpoint, if called.
  std::function<void(const std::function<Checkpoint()>& make)> between_steps;
  /// Checkpoint to continue from, made with the same mechanism, start, settings, reference and
  /// program; null: begins at the start.
  const Checkpoint* from = nullptr;
};

/// Columns of trajectory.csv: t, q, u, markers, energy, drifts, loop forces, efforts of drives, and
/// with `reactions` those of joints.
std::vector<std::string> trajectory_columns(const Mechanism& mechanism, bool reactions = false);

/// Runs once and measures the scene as written at every sample, whatever joints the run cuts. A
/// failure is in the result: status, reason and all samples up to it. cpu_s includes the measuring.
/// @throws std::invalid_argument for settings that are not finite or do not fit together, and for a
/// start of wrong size or not finite.
RunResult run_form(const Mechanism& mechanism, const Start& start, const RunRequest& request);

/// Sentence for a run that passed an ambiguous singular pose at t [s].
std::string ambiguous_from(double t);

/// The cost of a run without measuring.
struct TimedRun {
  double cpu_s = not_measured;   ///< processor time of the integration alone [s]
  double wall_s = not_measured;  ///< elapsed time of the integration [s]
  Counters counters;             ///< without the work of measuring
  std::string reason;            ///< why the run did not arrive; else empty
};
/// Times a run without measuring, of a mechanism as written: to time one of run_form(), give
/// IntegratedScene::mechanism() and start(). `settings`: of a finished run. `max_cpu_seconds`: 0:
/// none. `at_step` is called after each step; false ends the run.
TimedRun time_run(const Mechanism& mechanism, const Start& start, RunSettings settings,
                  double max_cpu_seconds = 0, const std::function<bool()>& at_step = {});

/// Default integrator of a form: ida for DAE forms; for ODE forms the one whose order costs least
/// at this tolerance: dp5 from 1e-4 up, vern9 from 1e-9 down, dop853 between.
std::string default_integrator(const std::string& form, double rtol);

/// Default settings of a run: both tolerances `rtol`; times, step, gauge and position correction of
/// the scene; the default integrator if `method` is empty. @throws std::invalid_argument for an
/// unknown integrator.
RunSettings default_settings(const RunDefaults& scene, const std::string& form,
                             const std::string& method, double rtol);

}  // namespace momenta
