// The verb `bench`: a suite of mechanisms, or of files of equations; parts of `work` on such files.

#include <momenta/dae/output/equation_report.h>
#include <momenta/dae/output/scene_suite_report.h>
#include <momenta/dae/output/submission.h>
#include <momenta/dae/study/environment.h>

#include <cstdio>
#include <type_traits>

#include "equation_verbs.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

/// Writes the files of either suite to --out, and prints its table. @return false where they cannot
/// be written
template <class Result>
bool told(const Options& o, const Result& result) {
  const Environment made = environment();
  const std::string json = suite_json(result, made).dump(2) + "\n";
  std::vector<ResultFile> files{{o.out / "bench.csv", suite_csv(result)},
                                {o.out / "bench.json", json},
                                {o.out / "index.html", suite_page(result, made, o.command)}};
  if constexpr (std::is_same_v<Result, SceneSuiteResult>)
    for (const auto& [name, text] : submissions(result, made))
      files.push_back({o.out / name, text});
  if (!o.out.empty() && !write_results(files)) return false;
  tell(o, json, suite_table(result), "index.html");
  return true;
}

int bench_scenes(const Options& o, bool own_references) {
  const SceneSuite suite = read_scene_suite(o.scene);
  expect_own_results(o.out, "bench.csv");
  watch_signals();
  SceneSuiteRequest request;
  request.own_references = own_references;
  request.max_cpu_seconds = o.cpu_limit.value_or(request.max_cpu_seconds);
  request.timing = timing_named(o.timing);
  SceneSuiteResult result;
  {
    ProgressLine line(o.quiet);
    request.progress = [&](int number, int total, const std::string& what) {
      return line.going(number, total, what, static_cast<double>(number - 1) / total);
    };
    result = run_suite(suite, request);
  }
  if (!told(o, result)) return run_failed;
  std::size_t ran = 0;
  for (const SceneProblemResult& p : result.problems)
    for (const RunResult& r : p.runs) ran += r.status == "done" ? 1 : 0;
  return ran > 0 && result.complete ? done : run_failed;
}

}  // namespace

int publish_suite(const Options& o, SuiteResult& result, bool own_references,
                  const std::function<void(const SuiteRequest&)>& run) {
  expect_own_results(o.out, "bench.csv");
  watch_signals();
  SuiteRequest request;
  request.own_references = own_references;
  request.max_cpu_seconds = o.cpu_limit.value_or(request.max_cpu_seconds);
  request.timing = o.timing == "none"   ? SuiteRequest::Timing::none
                   : o.timing == "once" ? SuiteRequest::Timing::once
                                        : SuiteRequest::Timing::rounds;
  {
    ProgressLine line(o.quiet);
    request.progress = [&](int number, int total, const std::string& what) {
      return line.going(number, total, what, static_cast<double>(number - 1) / total);
    };
    run(request);
  }
  if (!told(o, result)) return run_failed;
  std::size_t ran = 0;
  for (const ProblemResult& p : result.problems)
    for (const EquationRun& r : p.runs) ran += r.done ? 1 : 0;
  return ran > 0 && result.complete ? done : run_failed;
}

namespace {

int bench(const Options& o, bool own_references) {
  if (has_scenes(o.scene)) return bench_scenes(o, own_references);
  const Suite suite = read_suite(o.scene);
  SuiteResult result;
  return publish_suite(o, result, own_references,
                       [&](const SuiteRequest& request) { result = run_suite(suite, request); });
}

}  // namespace

Verb declare_bench(CLI::App& app, Options& o) {
  const auto own = std::make_shared<bool>(false);
  CLI::App& verb = add_verb(app, "bench", "A suite of mechanisms or of files of equations, scored",
                            "momenta bench examples/suites/ivp/suite.toml --out results");
  verb.add_option("suite", o.scene, "TOML file that lists problems, forms or methods, tolerances")
      ->required()
      ->type_name("FILE");
  verb.add_flag("--own-references", *own, "References are made anew, in quadruple precision");
  positive(verb.add_option("--cpu-limit", o.cpu_limit, "CPU time of a run [s] (default: 60)"), "S");
  add_timing(verb, o);
  add_out(verb, o, "Directory for bench.csv, bench.json, index.html");
  verb.add_flag("--json", o.json, "One JSON document on standard output");
  verb.add_flag("--quiet", o.quiet, "No progress, no table");
  return {&verb, [&o, own] { return bench(o, *own); }};
}

}  // namespace momenta::program
