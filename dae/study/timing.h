#pragma once
// How long finished runs take with nobody looking: rounds over all of them, so that a drifting
// clock hurts all alike, and medians. A run takes part until its median is settled. Of n times with
// quartiles q1, q3 the standard error of the median m is about 0.93 (q3 − q1) / √n (of normal
// scatter); a run has settled where that is below 2 % of m, after two rounds at the earliest.

#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/run_form.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// How runs are timed.
enum class Timing {
  none,   ///< not at all: times are not_measured
  once,   ///< one run each
  rounds  ///< until medians are settled
};
/// By name: none, once, rounds. @throws std::invalid_argument
Timing timing_named(const std::string& name);

/// Whether more times would hardly move the median of these.
bool is_settled(std::vector<double> times);

/// How time_runs is to go.
struct TimingRequest {
  Timing how = Timing::rounds;  ///< how often
  /// [s] of processor time a run, past which it takes no further round: a run of more than a second
  /// averages over its own steps.
  double budget = 1;
  Journal* journal = nullptr;  ///< every time is recorded, and taken from it when a study goes on
  std::function<bool(std::size_t)> going_on;  ///< asked before each run, with its number
  std::function<bool()> at_step;              ///< asked after each step; false ends it all
};

/// Medians in cpu_s, wall_s of all runs that are done; counters become those of a run with nobody
/// looking: without the stages and solutions that looking on takes.
void time_runs(const Mechanism& mechanism, const Start& start, std::vector<RunResult>& runs,
               const TimingRequest& request);

}  // namespace momenta
