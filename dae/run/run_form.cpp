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

/// A run in phases. Each has a form and an integrator of its own, and ends where a rigid stop is
/// met or let go, at an event, or at the end of the run: mostly there is one.
class Phases {
 public:
  Phases(const Mechanism& mechanism, const Start& start, const IntegratedScene& scene,
         const RunRequest& request, RunResult& result)
      : mechanism_(mechanism),
        start_(start),
        scene_(scene),
        request_(request),
        result_(result),
        rigid_(mechanism, result.settings.end_time - start.t),
        stops_(rigid_.any() ? &rigid_ : nullptr),
        faded_(static_cast<std::size_t>(scene.mechanism().m())) {}

  /// Makes form and integrator. False: there is no state to begin at, which the result says.
  bool begin();
  /// Integrates from the start, or from the request's checkpoint, up to the end or a rigid stop.
  void integrate();
  /// Whether a rigid stop ended the last phase, and another follows.
  bool goes_on() const { return monitor_->hit() && result_.status == "done" && !ended_; }
  /// Integrates from behind the impact, or the release.
  void integrate_on();
  /// What the end of the run tells.
  void finish();

 private:
  Observer observer();
  void watch_faded_rows();
  Checkpoint checkpoint(const std::function<void(Memory&)>& carry);
  double spent() const { return thread_seconds() - cpu_start_; }

  const Mechanism& mechanism_;
  const Start& start_;
  const IntegratedScene& scene_;
  const RunRequest& request_;
  RunResult& result_;
  RigidStops rigid_;
  RigidStops* stops_;  ///< null where there are none
  std::optional<FormRunner> runner_;
  std::optional<RunMonitor> monitor_;
  DriveReach reach_;
  std::vector<double> times_;  ///< of samples
  double wall_start_ = 0, cpu_start_ = 0;
  bool read_at_start_ = true;
  OdeForm* ode_ = nullptr;   ///< the form of a run of one phase; null: of DAEs, or with stops
  std::vector<long> faded_;  ///< by row: evaluations in which it faded
  IntegrationResult run_;    ///< counters of all phases
  long factorizations_ = 0;  ///< of earlier phases
  double last_hit_ = 0;      ///< [s]
  int at_once_ = 0;          ///< hits at the same moment
  bool ended_ = false;
};

bool Phases::begin() {
  Start begun = scene_.start();
  try {
    if (stops_) begun = stops_->begin(begun, result_);
    runner_.emplace(stops_ ? stops_->acting() : scene_.mechanism(), begun, result_.settings,
                    request_.max_cpu_seconds);
  } catch (const NoStateAtStart& none) {
    result_.status = "failed";
    result_.reason = none.what();
    result_.stopped_at = start_.t;
    return false;
  }
  judge_rank(mechanism_, start_, result_);
  reach_ = drive_reach(mechanism_, start_.t, start_.q, result_.settings.end_time);
  const Checkpoint* from = request_.from;
  if (from) result_ = from->so_far;
  wall_start_ = wall_now() - (from ? result_.wall_s : 0);
  cpu_start_ = thread_seconds() - (from ? result_.cpu_s : 0);
  monitor_.emplace(mechanism_, scene_, runner_->form(), start_, request_, result_, stops_);
  const auto y0 = runner_->form().initial(begun);
  read_at_start_ = from || monitor_->sample(start_.t, y0.data(), nullptr);
  ode_ = stops_ ? nullptr : dynamic_cast<OdeForm*>(&runner_->form());
  watch_faded_rows();
  times_ = output_times(result_.settings, request_.reference, reach_);
  monitor_->expect_samples_at(times_);
  return true;
}

void Phases::watch_faded_rows() {
  const Mechanism& integrated = scene_.mechanism();
  if (!ode_ || integrated.m() == 0) return;
  const int rank = scene_.anew() ? rank_at(integrated, scene_.start()).rank : result_.rank;
  ode_->watch_faded(&faded_, integrated.m() - rank);
}

Observer Phases::observer() {
  Observer all{[this](double t, const double* y, const double* ydot) {
                 return monitor_->sample(t, y, ydot);
               },
               [this](double t0, double t1, const Interpolant& between) {
                 return monitor_->step(t0, t1, between);
               },
               [this](const Interpolant& exact) { monitor_->take_exact(exact); },
               {}};
  if (request_.between_steps)
    all.before_step = [this](double t, const std::function<void(Memory&)>& carry) {
      if (!monitor_->can_be_put_down()) return;
      request_.between_steps([&] {
        Checkpoint made = checkpoint(carry);
        made.t = t;
        return made;
      });
    };
  return all;
}

Checkpoint Phases::checkpoint(const std::function<void(Memory&)>& carry) {
  Memory memory;
  monitor_->carry(memory);
  carry(memory);
  result_.cpu_s = spent();
  result_.wall_s = wall_now() - wall_start_;
  std::vector<std::vector<double>> rows;  // the caller keeps them
  std::swap(rows, result_.trajectory.rows);
  Checkpoint made{0, memory.numbers(), result_};
  std::swap(rows, result_.trajectory.rows);
  return made;
}

void Phases::integrate() {
  last_hit_ = start_.t - 1;
  Memory carried;
  if (request_.from) {
    carried = Memory(request_.from->memory);
    monitor_->carry(carried);
    runner_->go_on_from(carried, result_.cpu_s);
  }
  if (!times_.empty()) run_ = runner_->integrate(times_, observer());
}

void Phases::integrate_on() {
  ended_ = true;
  const RunMonitor::Hit hit = *monitor_->hit();
  constexpr int most_at_once = 50;
  at_once_ = hit.t > last_hit_ ? 0 : at_once_ + 1;
  last_hit_ = hit.t;
  if (at_once_ > most_at_once) {
    run_.reason = "at t = " + std::to_string(hit.t) + " s a rigid stop is met over and over";
    return;
  }
  // Phases may be too short to look at the clock.
  if (const double most = request_.max_cpu_seconds; most > 0 && spent() > most) {
    run_.reason = time_limit_sentence(result_.settings.integrator, most, hit.t);
    run_.end_time = hit.t;
    return;
  }
  const Counters so_far = run_.counters;
  factorizations_ += runner_->factorizations();
  run_.end_time = hit.t;
  try {
    double taken = 0;
    const Start begun = stops_->meet(hit.t, hit.q, hit.u, hit.stops, result_, taken);
    monitor_->take_energy(taken);
    RunSettings settings = result_.settings;
    runner_.emplace(stops_->acting(), begun, settings, request_.max_cpu_seconds);
    runner_->count_spent(spent());
  } catch (const std::runtime_error& none) {
    run_.reason = none.what();
    return;
  }
  // The first step is well below the pause: methods with memory begin at order 1.
  runner_->begin_with_step(0.1 * stops_->pause());
  monitor_->go_on(hit.t, runner_->form());
  std::vector<double> left;
  for (const double t : times_)
    if (t > hit.t) left.push_back(t);
  if (left.empty()) {
    run_.done = true;
    return;
  }
  run_ = runner_->integrate(left, observer());
  run_.counters += so_far;
  ended_ = false;
}

void Phases::finish() {
  result_.cpu_s = spent();
  result_.wall_s = wall_now() - wall_start_;
  result_.status =
      run_.done ? "done" : (run_.reason.rfind("time limit", 0) == 0 ? "time limit" : "failed");
  // A DAE that cannot be read at its start says why when it is started.
  const bool by_method =
      monitor_->trouble().empty() || (!read_at_start_ && runner_->form().is_dae());
  result_.reason = run_.done ? "" : by_method ? run_.reason : monitor_->trouble();
  result_.stopped_at = run_.end_time;
  if (!run_.done && !monitor_->came_apart().empty()) {
    result_.status = "came apart";
    result_.reason = monitor_->came_apart();
  }
  if (!monitor_->ended_by().empty()) {
    result_.status = "event";
    result_.reason = monitor_->ended_by();
    result_.stopped_at = monitor_->ended_at();
  } else {
    judge_drives(mechanism_, reach_, times_, monitor_->last_closed(), result_);
  }
  result_.stiff_from = run_.stiff_from;
  result_.changed_at = runner_->changed_at();
  result_.counters = run_.counters;
  result_.jacobian = run_.jacobian;
  result_.linear_solver = run_.linear_solver;
  result_.counters.factorizations += factorizations_ + runner_->factorizations();
  result_.partitions = runner_->form().partitions();
  const std::vector<RowName>& rows = scene_.mechanism().rows();
  for (std::size_t row = 0; row < faded_.size(); ++row)
    if (faded_[row] > 0)
      result_.faded_rows.push_back({rows[row].loop, rows[row].what, faded_[row]});
  if (ode_) result_.weak_evaluations = ode_->weak_evaluations();
  monitor_->finish();
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
  result.integrated = scene.in_words();
  Phases run(mechanism, start, scene, request, result);
  if (!run.begin()) return result;
  run.integrate();
  while (run.goes_on()) run.integrate_on();
  run.finish();
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
