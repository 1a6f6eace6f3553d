#include <momenta/dae/study/run_record.h>
#include <momenta/dae/study/timing.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

constexpr std::size_t most_rounds = 40;  // for runs of a millisecond
constexpr double least_seconds = 0.05;   // processor time before scatter counts
constexpr double settled_within = 0.02;  // part of the median

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

std::string key_of_time(const RunSettings& settings, std::size_t round) {
  return "time " + std::to_string(round) + " of " + key_of(settings);
}

/// Reason why a repeat does not time the run; empty: both took the same steps.
std::string another_course(const Counters& run, const TimedRun& repeat) {
  const Counters& again = repeat.counters;
  if (!repeat.reason.empty()) return "a repeat without measuring stopped: " + repeat.reason;
  if (again.steps == run.steps && again.rejected == run.rejected) return "";
  return "a repeat without measuring took " + std::to_string(again.steps) + " steps and " +
         std::to_string(again.rejected) + " rejected ones, not " + std::to_string(run.steps) +
         " and " + std::to_string(run.rejected);
}

}  // namespace

Timing timing_named(const std::string& name) {
  if (name == "none") return Timing::none;
  if (name == "once") return Timing::once;
  if (name == "rounds") return Timing::rounds;
  throw std::invalid_argument("timing '" + name + "' is not known; expected once, rounds or none");
}

bool is_settled(std::vector<double> times) {
  const std::size_t n = times.size();
  if (n < 2) return false;
  std::sort(times.begin(), times.end());
  const double spread = times[(3 * n) / 4] - times[n / 4 - (n % 4 == 0 ? 1 : 0)];
  return 0.93 * spread / std::sqrt(static_cast<double>(n)) <= settled_within * times[n / 2];
}

void time_runs(const Mechanism& mechanism, const Start& start, std::vector<RunResult>& runs,
               const TimingRequest& request) {
  struct Times {
    std::vector<double> cpu, wall;
    double spent = 0;
    bool over = false;
  };
  std::vector<Times> all(runs.size());
  const std::size_t rounds = has_rigid_stops(mechanism.scene()) ? 0  // timed runs know no impacts
                             : request.how == Timing::rounds    ? most_rounds
                             : request.how == Timing::once      ? 1
                                                                : 0;
  const auto measured = [&] {
    for (std::size_t round = 0; round < rounds; ++round)
      for (std::size_t i = 0; i < runs.size(); ++i) {
        Times& times = all[i];
        if (runs[i].status != "done" || times.over) continue;
        const std::string key = key_of_time(runs[i].settings, round);
        auto timed = recall<TimedRun>(request.journal, key);
        if (!timed) {
          if (request.going_on && !request.going_on(i)) return;
          timed = time_run(mechanism, start, runs[i].settings, request.max_cpu_seconds,
                           request.at_step);
          if (request.at_step && !request.at_step()) return;
          if (request.journal) request.journal->add(key, record_of(*timed));
        }
        if (const std::string why = another_course(runs[i].counters, *timed); !why.empty()) {
          runs[i].untimed = why;
          times.cpu.clear();
          times.over = true;
          continue;
        }
        times.cpu.push_back(timed->cpu_s);
        times.wall.push_back(timed->wall_s);
        times.spent += timed->cpu_s;
        runs[i].counters = timed->counters;
        times.over =
            times.spent > request.budget || (times.spent > least_seconds && is_settled(times.cpu));
      }
  };
  measured();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (request.how == Timing::none || !runs[i].untimed.empty())
      runs[i].cpu_s = runs[i].wall_s = std::numeric_limits<double>::quiet_NaN();
    if (all[i].cpu.empty()) continue;
    runs[i].repeats = static_cast<int>(all[i].cpu.size());
    runs[i].cpu_s = median(all[i].cpu);
    runs[i].wall_s = median(all[i].wall);
  }
}

}  // namespace momenta
