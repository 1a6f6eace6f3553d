#include <momenta/core/arguments.h>
#include <momenta/dae/assembly/drive_reach.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/solver/stopping.h>
#include <momenta/dae/study/run_monitor.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

namespace momenta {
namespace {

/// Uniform samples and the reference's own times, ascending, without the start; none beyond what
/// drives can reach.
std::vector<double> output_times(const RunSettings& s, const Reference* reference,
                                 const DriveReach& reach) {
  std::vector<double> times;
  for (int i = 1; i <= s.samples; ++i) times.push_back(s.end_time * i / s.samples);
  if (reference)
    for (double t : reference->times())
      if (t > 0 && t <= s.end_time * (1 + 1e-12)) times.push_back(std::min(t, s.end_time));
  std::sort(times.begin(), times.end());
  const double apart = 1e-12 * s.end_time;
  // Of two times that are one, keep the reference's: it comes with its own digits.
  times.erase(
      std::unique(times.begin(), times.end(), [&](double a, double b) { return b - a < apart; }),
      times.end());
  times.back() = s.end_time;
  if (!reach.obstacle.empty()) std::erase_if(times, [&](double t) { return !(t < reach.until); });
  return times;
}

}  // namespace

std::string default_integrator(const std::string& form, double rtol) {
  if (is_dae_form(form)) return "ida";
  // A tolerance typed as 1e-4 or 1e-9 may come by way of a logarithm.
  return rtol > 0.99e-4 ? "dp5" : rtol < 1.01e-9 ? "vern9" : "dop853";
}

RunSettings default_settings(const RunDefaults& scene, const std::string& form,
                             const std::string& method, double rtol) {
  RunSettings s;
  s.form = form;
  s.integrator = method.empty() ? default_integrator(form, rtol) : method;
  s.gauge = scene.leak ? Gauge{Gauge::Kind::leak, *scene.leak}.text() : "leak";
  s.rtol = s.atol = rtol;
  if (method.empty()) s.when_stiff = "bdf";
  s.step = scene.step.value_or(0);
  s.end_time = scene.end_time;
  s.samples = scene.samples;
  s.project = scene.project && integrator(s.integrator).projects;
  return s;
}

namespace {

/// @throws std::invalid_argument
void expect(bool holds, const char* name, double found, const char* expected) {
  if (!holds)
    throw std::invalid_argument(std::string(name) + " is " + in_words(found) + ", expected " +
                                expected);
}
void expect_numbers(const RunSettings& s) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  const auto not_negative = [](double x) { return x >= 0 && std::isfinite(x); };
  expect(positive(s.end_time), "the end time", s.end_time, "a positive number of seconds");
  expect(s.samples >= 1 && s.samples <= most_samples, "the number of samples", s.samples,
         "1 to 10000000");
  expect(not_negative(s.rtol), "rtol", s.rtol, "a tolerance, not negative");
  expect(not_negative(s.atol), "atol", s.atol, "a tolerance, not negative");
  expect(not_negative(s.step), "the step", s.step, "a positive number of seconds, or 0: none");
  const struct {
    const char* name;
    double x;
  } gains[] = {{"baumgarte_alpha", s.baumgarte_alpha},
               {"baumgarte_beta", s.baumgarte_beta},
               {"beta", s.beta},
               {"penalty", s.penalty}};
  for (const auto& [name, x] : gains)
    expect(not_negative(x), name, x, "a number, not negative; 0: the form's own");
  expect(s.spectral_radius >= 0 && s.spectral_radius < 1, "the spectral radius", s.spectral_radius,
         "0 or more, below 1");
}

/// A form with its integrator, ready to go; shared by the watched run and the timed ones.
class Runner {
 public:
  /// Completes the settings: default integrator, the gauge in force, gains, how (7) is solved.
  Runner(const Mechanism& mechanism, const Start& start, RunSettings& s, double max_cpu_seconds)
      : start_(start) {
    expect_numbers(s);
    const bool dae = is_dae_form(s.form);
    if (s.integrator.empty()) s.integrator = default_integrator(s.form, s.rtol);
    const Integrator& method = integrator(s.integrator);
    const auto wanted = dae ? Integrator::Takes::dae : Integrator::Takes::ode;
    if (method.takes != wanted)
      throw std::invalid_argument("form '" + s.form + "' is " + (dae ? "a DAE" : "an ODE") +
                                  ": expected integrator " + integrator_names(wanted) +
                                  ", found '" + s.integrator + "'");
    if (!method.takes_form(s.form, dae))
      throw std::invalid_argument("'" + s.integrator + "' is for form " + listed(method.forms) +
                                  ", found '" + s.form + "'");
    if (method.multistep && needs_one_step_method(s.form))
      throw std::invalid_argument("form '" + s.form + "' alters its state after steps, and '" +
                                  s.integrator + "' is a multistep method: expected rk4, dp5, " +
                                  "dop853 or vern9");
    if (s.project && !dae && !method.projects)
      throw std::invalid_argument(
          "'" + s.integrator + "' takes no correction after each step: expected no --project" +
          (method.multistep ? ", it would spoil the method's history" : ""));
    if (!dae && method.multistep && (s.gauge == "reset" || s.gauge == "flip"))
      throw std::invalid_argument("'" + s.integrator + "' is a multistep method: gauge " + s.gauge +
                                  " after each step would spoil its history; use leak or none");
    if (s.integrator == "rattle") s.gauge = "reset";  // its last stage does it
    FormOptions options;
    options.gauge = parse_gauge(s.gauge.empty() ? "none" : s.gauge);
    options.project = s.project;
    options.baumgarte_alpha = s.baumgarte_alpha;
    options.baumgarte_beta = s.baumgarte_beta;
    options.beta = s.beta;
    options.penalty = s.penalty;
    form_ = make_form(s.form, mechanism, options, start);
    s.form = form_->name();
    if (needs_one_step_method(s.form)) s.project = false;  // it corrects by its nature
    s.gauge = form_->momentum_like() && mechanism.m() > 0 ? form_->gauge().text() : "";
    std::tie(s.baumgarte_alpha, s.baumgarte_beta) = form_->baumgarte_gains();
    s.beta = form_->beta();
    s.penalty = form_->penalty();
    s.kkt = mechanism.m() == 0 || dae ? "" : name_of(mechanism.kkt());
    if (method.step == Integrator::Step::adaptive) s.step = 0;
    integrator_ = s.integrator;
    options_.rtol = s.rtol;
    options_.atol = s.atol;
    options_.step = s.step;
    options_.spectral_radius = s.spectral_radius;
    options_.max_cpu_seconds = max_cpu_seconds;
    if (!s.when_stiff.empty() && !may_change(s, options.gauge)) s.when_stiff.clear();
    when_stiff_ = s.when_stiff;
    options_.until_stiff = !when_stiff_.empty();
  }

  Form& form() { return *form_; }
  /// Systems solved by an ODE form.
  long factorizations() const {
    const auto* ode = dynamic_cast<const OdeForm*>(form_.get());
    return ode ? ode->factorizations() : 0;
  }

  IntegrationResult integrate(const std::vector<double>& times, const Observer& observer) {
    if (DaeSystem* dae = form_->dae())
      return momenta::integrate(integrator_, *dae, start_.t, times, options_, observer);
    const auto y0 = form_->initial(start_);
    const double began = thread_seconds();
    IntegrationResult run =
        momenta::integrate(integrator_, *form_->ode(), start_.t, y0, times, options_, observer);
    changed_at_ = not_measured;
    if (run.ended_stiff)
      go_on(run, times, observer, options_.spent_cpu_seconds + thread_seconds() - began);
    return run;
  }
  double changed_at() const { return changed_at_; }
  /// The next integration goes on with what another one carried.
  void go_on_from(const Memory& carried, double spent_cpu_seconds) {
    options_.carried = &carried;
    options_.spent_cpu_seconds = spent_cpu_seconds;
  }

 private:
  /// Whether `when_stiff`, a method with memory, takes the form as it is set.
  bool may_change(const RunSettings& s, const Gauge& gauge) {
    const Integrator& method = integrator(s.when_stiff);
    constexpr int most_unknowns =
        500;  // a larger dense Newton matrix may cost more than short steps
    return !is_dae_form(s.form) && s.step == 0 && form_->ode()->size() <= most_unknowns &&
           !needs_one_step_method(s.form) && (method.projects || !s.project) &&
           gauge.kind != Gauge::Kind::reset && gauge.kind != Gauge::Kind::flip;
  }

  /// The implicit method takes over where the explicit one ended.
  void go_on(IntegrationResult& run, const std::vector<double>& times, const Observer& observer,
             double cpu_s) {
    changed_at_ = run.end_time;
    std::vector<double> left;
    std::copy_if(times.begin(), times.end(), std::back_inserter(left),
                 [&](double t) { return t > run.end_time * (1 + 1e-14); });
    IntegrationOptions options = options_;
    options.carried = nullptr;
    options.spent_cpu_seconds = 0;
    if (options.max_cpu_seconds > 0)
      options.max_cpu_seconds = std::max(1e-3, options.max_cpu_seconds - cpu_s);
    const std::vector<double> y = std::move(run.y);
    IntegrationResult rest =
        momenta::integrate(when_stiff_, *form_->ode(), changed_at_, y, left, options, observer);
    rest.stiff_from = run.stiff_from;
    rest.counters += run.counters;
    run = std::move(rest);
  }

  const Start& start_;
  std::unique_ptr<Form> form_;
  std::string integrator_, when_stiff_;
  IntegrationOptions options_;
  double changed_at_ = not_measured;
};

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

namespace {

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
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  const LoopRank loops = loop_rank(mechanism, *e);
  result.rank = loops.rank;
  for (const int row : loops.dependent) {
    const RowName& name = mechanism.rows()[static_cast<std::size_t>(row)];
    result.dependent_rows.push_back({name.loop, name.what});
  }
  result.residue = residue_in_words(mechanism, start.residue);
}

/// A run that ends where drives cannot go on says so, whatever its method met there: where drives
/// alone move the loops that is known before it starts; else it is looked for next to the last
/// state with closed loops.
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
  std::optional<Runner> made;
  try {
    made.emplace(mechanism, start, result.settings, request.max_cpu_seconds);
  } catch (const NoStateAtStart& none) {
    result.status = "failed";
    result.reason = none.what();
    result.stopped_at = start.t;
    return result;
  }
  Runner& runner = *made;
  judge_rank(mechanism, start, result);
  const double end = result.settings.end_time;
  const DriveReach reach = drive_reach(mechanism, start.t, start.q, end);
  const Checkpoint* from = request.from;
  if (from) result = from->so_far;
  const double wall_start = wall_now() - (from ? result.wall_s : 0),
               cpu_start = thread_seconds() - (from ? result.cpu_s : 0);
  RunMonitor monitor(mechanism, runner.form(), start, request, result);
  const auto y0 = runner.form().initial(start);
  if (!from) monitor.sample(start.t, y0.data(), nullptr);
  auto* ode = dynamic_cast<OdeForm*>(&runner.form());
  std::vector<long> faded(static_cast<std::size_t>(mechanism.m()));
  if (ode && mechanism.m() > 0) ode->watch_faded(&faded, mechanism.m() - result.rank);
  const std::vector<double> times = output_times(result.settings, request.reference, reach);
  Observer observer{
      [&](double t, const double* y, const double* ydot) { return monitor.sample(t, y, ydot); },
      [&](double t0, double t1, const Interpolant& between) {
        return monitor.step(t0, t1, between);
      },
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
    runner.go_on_from(carried, result.cpu_s);
  }
  IntegrationResult run;
  if (!times.empty()) run = runner.integrate(times, observer);
  result.cpu_s = thread_seconds() - cpu_start;
  result.wall_s = wall_now() - wall_start;
  result.status =
      run.done ? "done" : (run.reason.rfind("time limit", 0) == 0 ? "time limit" : "failed");
  result.reason = run.done ? "" : (monitor.trouble().empty() ? run.reason : monitor.trouble());
  result.stopped_at = run.end_time;
  if (!run.done && !monitor.came_apart().empty()) {
    result.status = "came apart";
    result.reason = monitor.came_apart();
  }
  judge_drives(mechanism, reach, times, monitor.last_closed(), result);
  result.stiff_from = run.stiff_from;
  result.changed_at = runner.changed_at();
  result.counters = run.counters;
  result.jacobian = run.jacobian;
  result.linear_solver = run.linear_solver;
  result.counters.factorizations += runner.factorizations();
  result.partitions = runner.form().partitions();
  for (std::size_t row = 0; row < faded.size(); ++row)
    if (faded[row] > 0)
      result.faded_rows.push_back(
          {mechanism.rows()[row].loop, mechanism.rows()[row].what, faded[row]});
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
                  const std::function<bool()>& at_step) {
  Observer observer;
  if (at_step) observer.step = [&](double, double, const Interpolant&) { return at_step(); };
  Runner runner(mechanism, start, settings, 0);
  TimedRun timed;
  const double wall_start = wall_now(), cpu_start = thread_seconds();
  const IntegrationResult run = runner.integrate({settings.end_time}, observer);
  timed.cpu_s = thread_seconds() - cpu_start;
  timed.wall_s = wall_now() - wall_start;
  timed.counters = run.counters;
  timed.counters.factorizations += runner.factorizations();
  return timed;
}

}  // namespace momenta
