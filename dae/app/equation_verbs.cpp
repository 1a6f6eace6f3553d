// The verbs `run`, `index` and `work` of files of equations.

#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/output/equation_report.h>
#include <momenta/dae/study/environment.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "equation_verbs.h"
#include "loading.h"
#include "progress.h"
#include "results.h"

namespace momenta::program {
namespace {

void expect_options(const Options& o, const std::vector<std::string_view>& allowed) {
  for (const std::string& name : o.given)
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end())
      throw std::invalid_argument(o.scene.string() + " holds equations: found the option " + name +
                                  " of mechanisms, expected none but " + reading::listed(allowed));
}

EquationFile read_file(const Options& o) {
  EquationFile file = read_equations(o.scene, settings_of(o));
  if (o.end) {
    if (!(*o.end > file.start))
      throw std::invalid_argument("--end " + compact(*o.end, 6) + ": expected a time after " +
                                  compact(file.start, 6) + ", the start of " + o.scene.string());
    file.end = *o.end;
    if (file.reference && file.reference->t != file.end) file.reference.reset();
  }
  file.samples = o.samples.value_or(file.samples);
  return file;
}

EquationStart start_or_sentence(const EquationFile& file) {
  EquationStart start = equation_start(file);
  if (!start.point.why.empty())
    throw std::runtime_error(file.where({}) + "no consistent start: " + start.point.why);
  return start;
}

}  // namespace

int index_of_equations(const Options& o) {
  expect_options(o, {"--set", "--cpu-limit", "--out", "--json", "--quiet"});
  const CpuLimit limit(o.cpu_limit.value_or(0));
  const EquationFile file = read_file(o);
  const EquationStart start = equation_start(file);
  const std::string json = equation_index_json(file, start).dump(2) + "\n";
  if (!o.out.empty() && !write_results({{o.out / "index.json", json}})) return run_failed;
  tell(o, json, equation_index_table(file, start), "index.json");
  return start.point.why.empty() ? done : run_failed;
}

int run_equation_file(const Options& o) {
  expect_options(o, {"--set", "--integrator", "--rtol", "--atol", "--step", "--end", "--samples",
                     "--cpu-limit", "--timing", "--out", "--json", "--quiet"});
  const EquationFile file = read_file(o);
  const EquationStart start = start_or_sentence(file);
  expect_own_results(o.out, "trajectory.csv");
  watch_signals();
  EquationRunRequest request;
  request.integrator = o.integrator.empty() ? integrator_for(file, start) : o.integrator;
  request.rtol = o.rtol;
  request.atol = o.atol.value_or(o.rtol);
  request.step = o.step.value_or(0);
  request.end = file.end;
  request.samples = file.samples;
  request.max_cpu_seconds = o.cpu_limit.value_or(0);
  EquationRun run;
  {
    ProgressLine line(o.quiet);
    request.going_on = [&](double t) {
      line.show(request.integrator + "  t = " + compact(t, 4));
      return !interrupted();
    };
    run = run_equations(file, start, request);
  }
  if (o.timing == "none") run.cpu_s = std::numeric_limits<double>::quiet_NaN();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Digits digits = file.reference && file.reference->t == file.end
                            ? digits_of(run, file, file.reference->values, file.reference->judged)
                            : Digits{nan, nan};
  const Environment made = environment();
  const std::string json = equation_run_json(file, start, run, digits, made).dump(2) + "\n";
  if (!o.out.empty() &&
      !write_results(
          {{o.out / "trajectory.csv", equation_trajectory(file, run)},
           {o.out / "summary.json", json},
           {o.out / "index.html", equation_run_page(file, start, run, digits, made, o.command)}}))
    return run_failed;
  tell(o, json, equation_run_table(file, start, run, digits));
  if (!run.done) std::fprintf(stderr, "momenta: the run stopped: %s\n", run.reason.c_str());
  return run.done ? done : run_failed;
}

int work_on_equations(const Options& o, const WorkOptions& w) {
  expect_options(o, {"--set", "--integrators", "--from", "--to", "--per-decade", "--end",
                     "--cpu-limit", "--timing", "--out", "--json", "--quiet"});
  const EquationFile file = read_file(o);
  SuiteProblem problem;
  problem.file = o.scene.string();
  problem.methods =
      w.integrators.empty() ? std::vector<std::string>{"ida", "radau5"} : names_in(w.integrators);
  for (const std::string& name : problem.methods)
    if (name != "ida" && name != "radau5")
      throw std::invalid_argument("--integrators " + w.integrators +
                                  ": expected ida, radau5 or both for equations");
  problem.tolerances = tolerance_rungs(w);
  SuiteResult result;
  result.name = file.name;
  return publish_suite(o, result, false, [&](const SuiteRequest& request) {
    result.problems.push_back(run_problem(file, problem, request, [&](const std::string& what) {
      return result.complete = request.progress(1, 1, what);
    }));
  });
}

}  // namespace momenta::program
