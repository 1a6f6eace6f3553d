#pragma once
// The time of finished runs without measuring. They are timed in rounds, so that a drift of the
// clock affects all alike, and the median is taken. A run takes part until its median is settled.
// For n times with quartiles q1, q3 and normal scatter, the standard error of the median m is about
// 0.93 (q3 − q1) / √n; the median is settled when that is below 2 % of m, after two rounds at the
// earliest.

#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/journal.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// How runs are timed.
enum class Timing {
  none,   ///< no timing: times are not_measured
  once,   ///< one run each
  rounds  ///< until medians are settled
};
/// Reads none, once or rounds. @throws std::invalid_argument
Timing timing_named(const std::string& name);

/// Whether the median of these times is settled.
bool is_settled(std::vector<double> times);

/// Options of time_runs.
struct TimingRequest {
  Timing how = Timing::rounds;  ///< none, once or in rounds
  /// Processor time per run [s] after which it takes part in no further round: long runs average
  /// over their own steps.
  double budget = 1;
  /// Journal of the times, for studies that continue; or null.
  Journal* journal = nullptr;
  double max_cpu_seconds = 0;                 ///< per run [s]; 0: none
  std::function<bool(std::size_t)> going_on;  ///< asked before each run, by number; false: stop
  std::function<bool()> at_step;              ///< asked after each step; false: stop
};

/// Sets cpu_s and wall_s of finished runs to their medians, and their counters to those of a run
/// without measuring. Both take the same steps unless the solver remembers earlier solutions
/// (LoopSolver::remembers); where they differ the times are not_measured and `untimed` says so.
void time_runs(const Mechanism& mechanism, const Start& start, std::vector<RunResult>& runs,
               const TimingRequest& request);

}  // namespace momenta
