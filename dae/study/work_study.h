#pragma once
// The work-precision study: error against run time, for every requested form and integrator, over a
// ladder of tolerances, or of steps where a method has no error control.

#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/timing.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

struct WorkRequest {
  std::vector<std::string> forms;        ///< empty: all
  std::vector<std::string> integrators;  ///< each for the forms it takes; empty: dop853, ida, and
                                         ///< bdf where dop853 finds the problem stiff
  std::string gauge;                     ///< for momentum forms; empty: by form and integrator
  std::vector<double> tolerances;        ///< rtol = atol, falling
  std::vector<double> steps;             ///< for fixed-step methods [s], falling
  double end_time = 10;                  ///< [s]
  int samples = 100;
  const Reference* reference = nullptr;  ///< bound; errors are largest over its times
  bool keep_trajectories = false;        ///< fills RunResult::trajectory of each run
  Timing timing = Timing::rounds;
  double max_cpu_seconds = 10;  ///< per run; a ladder ends at the first rung that needs more
  Journal* journal = nullptr;   ///< journal of finished runs, or null
  /// Called before and during each run (number, of how many, label, fraction done); false stops.
  std::function<bool(int, int, const std::string&, double)> progress;
};

/// The runs, ladder by ladder. Times are medians of rounds over all runs of the study.
std::vector<RunResult> run_work_study(const Mechanism& mechanism, const Start& start,
                                      const WorkRequest& request);

/// Measure of a run: its error against the reference, or without one its largest drift.
double judged_error(const RunResult& run, bool has_reference);

/// Runs that no other beats in both error and CPU time, by falling error; none where they ended on
/// different branches of the motion.
std::vector<std::size_t> pareto_front(const std::vector<RunResult>& runs, bool has_reference);

}  // namespace momenta
