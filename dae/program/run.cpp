#include <momenta/dae/report/csv.h>
#include <momenta/dae/report/number_text.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/report/table.h>
#include <momenta/dae/study/run_form.h>

#include <cstdio>

#include "options.h"

namespace momenta::program {
namespace {

constexpr int most_drawn = 4000;  // samples that a page is made of

void print_passages(const RunResult& result) {
  constexpr std::size_t most = 12;
  if (result.passages.empty()) return;
  std::string times;
  for (std::size_t i = 0; i < result.passages.size() && i < most; ++i)
    times += (i == 0 ? "" : ", ") + compact(result.passages[i].t, 4);
  std::printf("\nClose to singular poses at t = %s%s s, least pivot %s\n", times.c_str(),
              result.passages.size() > most ? ", …" : "",
              scientific(result.least_pivot, 1).c_str());
  for (const RunResult::Passage& passage : result.passages)
    if (passage.ambiguous) {
      std::printf("Ambiguous: %s\n", ambiguous_from(passage.t).c_str());
      break;
    }
}

}  // namespace

int run(const Options& o) {
  const auto mechanism = load(o);
  const auto reference = load_reference(o, *mechanism);
  const Assembly a = assemble(*mechanism);
  RunRequest request;
  request.settings = run_settings(o, mechanism->scene().run);
  const RunSettings& s = request.settings;
  request.reference = reference.get();
  request.keep_trajectory = true;
  request.max_cpu_seconds = o.cpu_limit.value_or(0);
  request.film_intervals = film_intervals_of(*mechanism, o, 1);
  expect_own_results(o.out, "trajectory.csv");
  const auto file = trajectory_file(o, *mechanism, s);
  if (file) {
    // What the page draws is a part of it; memory does not grow with the trajectory.
    request.keep_every = 1 + s.samples / most_drawn;
    request.on_row = [&](const std::vector<double>& row) { return file->write(row); };
  }
  ProgressLine line(o.quiet);
  request.progress = [&](double t) {
    line.show(s.form + "  t = " + std::to_string(t) + " s");
    return !interrupted();
  };
  StudyResult study;
  study.runs.push_back(run_form(*mechanism, a.start, request));
  if (!interrupted()) time_runs(*mechanism, a.start, study.runs, 3);
  line.show("");
  const RunResult& result = study.runs.front();
  study.reference = o.reference.string();
  describe(study, o, *mechanism, a);
  if (interrupted())
    study.runs.front().reason = "interrupted at t = " + std::to_string(result.stopped_at) + " s";
  auto json = summary_json(result, study.environment);
  json["assembly"] = {{"moved", a.moved}, {"branch", a.branch}};
  const std::string summary = json.dump(2) + "\n";
  if (file && !file->finish(summary)) {
    std::fprintf(stderr, "momenta: %s\n", file->problem().c_str());
    return run_failed;
  }
  if (!o.out.empty() &&
      (!(file || write_result(o.out / "trajectory.csv", trajectory_csv(result.trajectory))) ||
       !write_result(o.out / "summary.json", summary) ||
       !write_result(o.out / "index.html", run_page(study))))
    return run_failed;
  if (!o.out.empty()) {
    // Of an earlier run in the other format.
    std::error_code ignored;
    std::filesystem::remove(o.out / (file ? "trajectory.csv" : "run.h5"), ignored);
  }
  if (!o.figures.empty() && !write_figures(figures_of_run(study), o)) return run_failed;
  if (o.json) {
    std::fputs(summary.c_str(), stdout);
  } else if (!o.quiet) {
    std::fputs(drift_table(study).c_str(), stdout);
    print_passages(result);
    if (!a.branch.empty()) std::printf("Started from %s\n", a.branch.c_str());
  }
  if (result.status == "done") return done;
  std::fprintf(stderr, "momenta: the run stopped: %s\n", result.reason.c_str());
  return run_failed;
}

}  // namespace momenta::program
