#pragma once
// A run: a form, an integrator, and everything measured during the integration.

#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/measure/reference.h>
#include <momenta/dae/study/run_result.h>

#include <functional>

namespace momenta {

class IntegratedScene;  // dae/cut/integrated_scene.h

/// The state of a run between two steps, from which the run can continue.
struct Checkpoint {
  double t = 0;                ///< [s]
  std::vector<double> memory;  ///< what the integrator, the form and the measures carry
  /// What was measured so far, without the rows of the trajectory, which the caller keeps.
  RunResult so_far;
};

/// The request for one run: its settings, what it keeps, and the functions it calls.
struct RunRequest {
  RunSettings settings;  ///< form, integrator, tolerances, times
  /// What the run integrates, made of the same mechanism and start; null: chosen for this run.
  const IntegratedScene* integrated = nullptr;
  /// Bound to trajectory_columns(mechanism), or to those with the reactions.
  const Reference* reference = nullptr;
  bool keep_trajectory = false;  ///< RunResult::trajectory is filled
  /// RunResult::multiplier_difference_max is measured. A reference with forces says so by itself.
  bool multipliers = false;
  bool events = false;     ///< those of the scene are looked for, and may end the run
  bool reactions = false;  ///< with the reactions of joints among its columns
  int keep_every = 1;      ///< keep every n-th row, from the first
  /// Called with every row of the trajectory, where a trajectory is kept; return false to stop the
  /// run.
  std::function<bool(const std::vector<double>& row)> on_row;
  /// Number of equal intervals of the film after the start; a run that fails has fewer. 0: no film.
  int film_intervals = 0;
  double max_cpu_seconds = 0;  ///< 0: none
  /// Called with the time of each sample; return false to stop the run.
  std::function<bool(double t)> progress;
  /// Called after each step; return false to stop the run.
  std::function<bool()> going_on;
  /// Called between steps of a run that another process can continue from there, to the last bit: a
  /// run by an explicit Runge-Kutta method, unless its form or solver carries more than a list of
  /// numbers (`partitioned`; KLU). Calling `make` is optional; it makes the checkpoint.
  std::function<void(const std::function<Checkpoint()>& make)> between_steps;
  /// The checkpoint from which the run continues, made with the same mechanism, start, settings,
  /// reference and program; null: the run begins at the start.
  const Checkpoint* from = nullptr;
};

/// Columns of trajectory.csv: t, q, u, markers, energy, drifts, loop forces, efforts of drives; and
/// the reactions of joints where they are asked for.
std::vector<std::string> trajectory_columns(const Mechanism& mechanism, bool reactions = false);

/// Runs once and measures at every sample; all that is measured is of the scene as written,
/// whatever joints the run cuts. A failure is in the result: status, reason and all samples up to
/// it. cpu_s includes the measuring. @throws std::invalid_argument for settings that are not finite
/// or do not fit together, and for a start of wrong size or with numbers that are not finite.
RunResult run_form(const Mechanism& mechanism, const Start& start, const RunRequest& request);

/// The sentence for a run that passed an ambiguous singular pose at time t [s].
std::string ambiguous_from(double t);

/// The cost of a run without measuring.
struct TimedRun {
  double cpu_s = not_measured;   ///< processor time of the integration alone [s]
  double wall_s = not_measured;  ///< elapsed time of it [s]
  Counters counters;             ///< without the work of measuring
  std::string reason;            ///< why it did not arrive; empty: it did
};
/// Times a run without measuring, of a mechanism as it is written: to time one of run_form(), give
/// IntegratedScene::mechanism() and start(). `settings`: those of a run that is done.
/// `max_cpu_seconds`: 0: none. `at_step` is called after each step; return false to end the run.
TimedRun time_run(const Mechanism& mechanism, const Start& start, RunSettings settings,
                  double max_cpu_seconds = 0, const std::function<bool()>& at_step = {});

/// The default integrator of a form. For DAE forms it is ida; for ODE forms the one whose order
/// costs least at this tolerance: dp5 from 1e-4 up, vern9 from 1e-9 down, dop853 between.
std::string default_integrator(const std::string& form, double rtol);

/// The default settings of a run of this form: both tolerances `rtol`; times, step, gauge and
/// position correction of the scene; the default integrator where `method` is empty. @throws
/// std::invalid_argument for an unknown integrator.
RunSettings default_settings(const RunDefaults& scene, const std::string& form,
                             const std::string& method, double rtol);

}  // namespace momenta
