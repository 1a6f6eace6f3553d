#include <momenta/core/open_chain/arguments.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/stopping.h>
#include <momenta/dae/run/form_runner.h>
#include <momenta/dae/run/rank_at_start.h>
#include <momenta/dae/run/rigid_stops.h>
#include <momenta/dae/run/run_monitor.h>
#include <momenta/dae/run/run_settings.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

namespace momenta {
namespace {

/// Uniform samples and the reference's times, ascending, without the start, as far as drives reach.
std::vector<double> output_times(const RunSettings& s, const Reference* reference,
                                 const DriveReach& reach) {
  std::vector<double> times;
  for (int i = 1; i <= s.samples; ++i) times.push_back(s.end_time * i / s.samples);
  if (reference)
    for (double t : reference->times())
      if (t > 0 && t <= s.end_time * (1 + 1e-12)) times.push_back(std::min(t, s.end_time));
  std::sort(times.begin(), times.end());
  const double apart = 1e-12 * s.end_time;
  // Times apart by rounding are one.
  times.erase(
      std::unique(times.begin(), times.end(), [&](double a, double b) { return b - a < apart; }),
      times.end());
  times.back() = s.end_time;
  if (!reach.obstacle.empty()) std::erase_if(times, [&](double t) { return !(t < reach.until); });
  return times;
}

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// @throws std::invalid_argument
void expect_start(const Mechanism& mechanism, const Start& s) {
  expect(std::isfinite(s.t), "t of the start", s.t, "a time in seconds");
  const struct {
    const char* name;
    const Eigen::VectorXd& x;
    int size;
  } all[] = {{"q of the start", s.q, mechanism.nq()},
             {"u of the start", s.u, mechanism.nv()},
             {"udot of the start", s.udot, mechanism.nv()},
             {"lambda of the start", s.lambda, mechanism.m()}};
  if (s.residue.size() > 0)
    expect_size("run_form", "residue of the start", s.residue.size(), mechanism.m());
  for (const auto& [name, x, size] : all) {
    expect_size("run_form", name, x.size(), size);
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (!std::isfinite(x[i]))
        throw std::invalid_argument("run_form: " + not_finite(name, i, x[i]));
  }
}

/// Rank, redundant rows and residue at the start.
void judge_rank(const Mechanism& mechanism, const Start& start, RunResult& result) {
  if (mechanism.m() == 0) return;
  const LoopRank loops = rank_at(mechanism, start);
  result.rank = loops.rank;
  for (const int row : loops.dependent) {
    const RowName& name = mechanism.rows()[static_cast<std::size_t>(row)];
    result.dependent_rows.push_back({name.loop, name.what});
  }
  result.residue = residue_in_words(mechanism, start.residue);
}

/// Makes drives that cannot go on the reason of a run's end: known beforehand where drives alone
/// move the loops, else looked for next to the last state with closed loops.
void judge_drives(const Mechanism& mechanism, const DriveReach& reach,
                  const std::vector<double>& times, const RunMonitor::Closed& closed,
                  RunResult& result) {
  const RunSettings& s = result.settings;
  const double spacing = s.end_time / s.samples;
  const auto stalled = [&](const DriveReach& found) {
    result.status = "failed";
    result.reason = found.obstacle;
    result.stopped_at = found.until;
  };
  if (!reach.obstacle.empty()) {
    // Next to a dead point rates have no bound, and a method may give up a little before it.
    const double last = times.empty() ? 0 : times.back();
    if (result.status == "done" || times.empty() || last - result.stopped_at <= 2 * spacing)
      stalled(reach);
    return;
  }
  if ((result.status != "failed" && result.status != "came apart") || closed.q.size() == 0) return;
  const double later = std::max(1e-3 * s.end_time, 0.1 * (result.stopped_at - closed.t));
  const DriveReach near =
      drive_reach(mechanism, closed.t, closed.q, std::min(s.end_time, result.stopped_at + later),
                  Followed::all);
  if (!near.obstacle.empty()) stalled(near);
}

}  // namespace

RunResult run_form(const Mechanism& mechanism, const Start& start, const RunRequest& request) {
  expect_start(mechanism, start);
  expect(request.keep_every >= 1, "keep_every", request.keep_every, "1 or more");
  expect(request.max_cpu_seconds >= 0, "the limit of CPU time", request.max_cpu_seconds,
         "seconds, or 0: none");
  RunResult result;
  result.scene = mechanism.scene().name;
  result.settings = request.settings;
  std::optional<IntegratedScene> chosen;
  const IntegratedScene& scene =
      request.integrated ? *request.integrated : chosen.emplace(mechanism, start);
  const Mechanism& integrated = scene.mechanism();
  result.integrated = scene.in_words();
  RigidStops rigid(mechanism, result.settings.end_time - start.t);
  RigidStops* stops = rigid.any() ? &rigid : nullptr;
  Start begun = scene.start();  // start of the phase
  std::optional<FormRunner> made;
  try {
    if (stops) begun = stops->begin(begun, result);
    made.emplace(stops ? stops->acting() : integrated, begun, result.settings,
                 request.max_cpu_seconds);
  } catch (const NoStateAtStart& none) {
    result.status = "failed";
    result.reason = none.what();
    result.stopped_at = start.t;
    return result;
  }
  judge_rank(mechanism, start, result);
  const double end = result.settings.end_time;
  const DriveReach reach = drive_reach(mechanism, start.t, start.q, end);
  const Checkpoint* from = request.from;
  if (from) result = from->so_far;
  const double wall_start = wall_now() - (from ? result.wall_s : 0),
               cpu_start = thread_seconds() - (from ? result.cpu_s : 0);
  RunMonitor monitor(mechanism, scene, made->form(), start, request, result, stops);
  const auto y0 = made->form().initial(begun);
  const bool read = from || monitor.sample(start.t, y0.data(), nullptr);
  auto* ode = stops ? nullptr : dynamic_cast<OdeForm*>(&made->form());
  std::vector<long> faded(static_cast<std::size_t>(integrated.m()));
  if (ode && integrated.m() > 0) {
    const int rank = scene.anew() ? rank_at(integrated, scene.start()).rank : result.rank;
    ode->watch_faded(&faded, integrated.m() - rank);
  }
  const std::vector<double> times = output_times(result.settings, request.reference, reach);
  monitor.expect_samples_at(times);
  Observer observer{
      [&](double t, const double* y, const double* ydot) { return monitor.sample(t, y, ydot); },
      [&](double t0, double t1, const Interpolant& between) {
        return monitor.step(t0, t1, between);
      },
      [&](const Interpolant& exact) { monitor.take_exact(exact); },
      {}};
  if (request.between_steps)
    observer.before_step = [&](double t, const std::function<void(Memory&)>& carry) {
      if (!monitor.can_be_put_down()) return;
      request.between_steps([&] {
        Memory memory;
        monitor.carry(memory);
        carry(memory);
        result.cpu_s = thread_seconds() - cpu_start;
        result.wall_s = wall_now() - wall_start;
        std::vector<std::vector<double>> rows;
        std::swap(rows, result.trajectory.rows);
        Checkpoint made_here{t, memory.numbers(), result};
        std::swap(rows, result.trajectory.rows);
        return made_here;
      });
    };
  Memory carried;
  if (from) {
    carried = Memory(from->memory);
    monitor.carry(carried);
    made->go_on_from(carried, result.cpu_s);
  }
  IntegrationResult run;
  if (!times.empty()) run = made->integrate(times, observer);
  long factorizations = 0;
  double last_hit = start.t - 1;
  int at_once = 0;
  while (monitor.hit() && result.status == "done") {
    const RunMonitor::Hit hit = *monitor.hit();
    constexpr int most_at_once = 50;
    at_once = hit.t > last_hit ? 0 : at_once + 1;
    last_hit = hit.t;
    if (at_once > most_at_once) {
      run.reason = "at t = " + std::to_string(hit.t) + " s a rigid stop is met over and over";
      break;
    }
    const Counters so_far = run.counters;
    factorizations += made->factorizations();
    run.end_time = hit.t;
    try {
      double taken = 0;
      begun = stops->meet(hit.t, hit.q, hit.u, hit.stops, result, taken);
      monitor.take_energy(taken);
      RunSettings settings = result.settings;
      const double spent = thread_seconds() - cpu_start;
      made.emplace(
          stops->acting(), begun, settings,
          request.max_cpu_seconds > 0 ? std::max(1e-3, request.max_cpu_seconds - spent) : 0);
    } catch (const std::runtime_error& none) {
      run.reason = none.what();
      break;
    }
    // The first step is well below the pause: methods with memory begin at order 1.
    made->begin_with_step(0.1 * stops->pause());
    monitor.go_on(hit.t, made->form());
    std::vector<double> left;
    for (const double t : times)
      if (t > hit.t) left.push_back(t);
    if (left.empty()) {
      run.done = true;
      break;
    }
    run = made->integrate(left, observer);
    run.counters += so_far;
  }
  result.cpu_s = thread_seconds() - cpu_start;
  result.wall_s = wall_now() - wall_start;
  result.status =
      run.done ? "done" : (run.reason.rfind("time limit", 0) == 0 ? "time limit" : "failed");
  // A DAE that cannot be read at its start says why when it is started.
  const bool by_method = monitor.trouble().empty() || (!read && made->form().is_dae());
  result.reason = run.done ? "" : by_method ? run.reason : monitor.trouble();
  result.stopped_at = run.end_time;
  if (!run.done && !monitor.came_apart().empty()) {
    result.status = "came apart";
    result.reason = monitor.came_apart();
  }
  if (!monitor.ended_by().empty()) {
    result.status = "event";
    result.reason = monitor.ended_by();
    result.stopped_at = monitor.ended_at();
  } else {
    judge_drives(mechanism, reach, times, monitor.last_closed(), result);
  }
  result.stiff_from = run.stiff_from;
  result.changed_at = made->changed_at();
  result.counters = run.counters;
  result.jacobian = run.jacobian;
  result.linear_solver = run.linear_solver;
  result.counters.factorizations += factorizations + made->factorizations();
  result.partitions = made->form().partitions();
  for (std::size_t row = 0; row < faded.size(); ++row)
    if (faded[row] > 0)
      result.faded_rows.push_back(
          {integrated.rows()[row].loop, integrated.rows()[row].what, faded[row]});
  if (ode) result.weak_evaluations = ode->weak_evaluations();
  monitor.finish();
  return result;
}

std::string ambiguous_from(double t) {
  char time[32];
  std::snprintf(time, sizeof time, "%.4g", t);
  return "from t = " + std::string(time) +
         " s the motion is one of several: its loops are open by more than tells apart those that "
         "meet in the singular pose there";
}

TimedRun time_run(const Mechanism& mechanism, const Start& start, RunSettings settings,
                  double max_cpu_seconds, const std::function<bool()>& at_step) {
  Observer observer;
  if (at_step) observer.step = [&](double, double, const Interpolant&) { return at_step(); };
  FormRunner runner(mechanism, start, settings, max_cpu_seconds);
  TimedRun timed;
  const double wall_start = wall_now(), cpu_start = thread_seconds();
  const IntegrationResult run = runner.integrate({settings.end_time}, observer);
  timed.cpu_s = thread_seconds() - cpu_start;
  timed.wall_s = wall_now() - wall_start;
  timed.counters = run.counters;
  timed.counters.factorizations += runner.factorizations();
  if (!run.done) timed.reason = run.reason;
  return timed;
}

}  // namespace momenta
