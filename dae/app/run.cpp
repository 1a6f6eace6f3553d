#include <momenta/dae/integrator/stopping.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/output/run_report.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/passed_limits.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/timing.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "checkpoint_file.h"
#include "equation_verbs.h"
#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

constexpr int most_drawn = 4000;  // samples in a page

/// The files of a run: the trajectory, written during the run, and a summary with reserved room.
class RunFiles {
 public:
  /// @throws std::invalid_argument, std::runtime_error
  RunFiles(const Options& o, const Mechanism& mechanism, const RunSettings& settings)
      : o_(o),
        kept_(o, trajectory_columns(mechanism, o.reactions).size()),
        trajectory_(trajectory_file(o, mechanism, settings, kept_.trajectory())) {
    if (!trajectory_) return;
    summary_.emplace(o.out / "summary.json");
    if (!summary_->reserve(summary_room)) throw std::runtime_error(summary_->problem());
    kept_.begin();
    if (kept_.from()) last_row_ = kept_.from()->so_far.trajectory.rows.back();
  }

  bool write(const std::vector<double>& row) {
    if (!trajectory_) return true;
    last_row_ = row;
    return trajectory_->write(row);
  }
  /// Where to continue; null: at the start.
  const Checkpoint* from() const { return kept_.from(); }
  /// Takes a checkpoint between two steps.
  void note(const std::function<Checkpoint()>& make) {
    if (trajectory_) kept_.note(*trajectory_, last_row_, make);
  }
  bool flush() { return !trajectory_ || trajectory_->flush(); }
  /// Why rows could not be written; empty: all were.
  std::string problem() const { return trajectory_ ? trajectory_->problem() : ""; }

  /// Gives files their names, `others` too if there is room; else prints the sentence and returns
  /// false. `over`: the run will not continue.
  bool finish(const std::string& summary, const std::vector<ResultFile>& others, bool over) {
    if (!trajectory_) return true;
    const bool told = !problem().empty();  // why the run ended
    if (!trajectory_->finish(summary)) return !told && complain(problem());
    summary_->append(summary);
    const bool all = summary_->put_in_place() || complain(summary_->problem());
    // A file of an earlier run would contradict them.
    std::error_code ignored;
    std::filesystem::remove(o_.out / (o_.data == "hdf5" ? "trajectory.csv" : "run.h5"), ignored);
    if (write_results(others)) {
      if (all && over) kept_.remove();
      return all;
    }
    for (const ResultFile& other : others) std::filesystem::remove(other.path, ignored);
    return false;
  }

 private:
  static constexpr std::size_t summary_room = 1 << 16;
  static bool complain(const std::string& sentence) {
    std::fprintf(stderr, "momenta: %s\n", sentence.c_str());
    return false;
  }

  const Options& o_;
  CheckpointFile kept_;
  std::unique_ptr<TrajectoryFile> trajectory_;
  std::vector<double> last_row_;
  std::optional<PartFile> summary_;
};

int run(const Options& o) {
  const double limit = o.cpu_limit.value_or(0);
  const CpuLimit before(limit);
  const auto mechanism = load(o);
  const auto reference = load_reference(o, *mechanism);
  const Assembly a = assemble(*mechanism);
  const IntegratedScene integrated(*mechanism, a.start);
  RunRequest request;
  request.settings = run_settings(o, mechanism->scene().run);
  request.integrated = &integrated;
  const RunSettings& s = request.settings;
  request.reference = reference.get();
  request.keep_trajectory = true;
  request.reactions = o.reactions;
  request.multipliers = true;
  request.events = true;
  // Time before the run counts.
  if (limit > 0) request.max_cpu_seconds = std::max(1e-3, limit - thread_seconds());
  request.film_intervals = film_intervals_of(*mechanism, o, 1);
  expect_own_results(o.out, "trajectory.csv");
  RunFiles files(o, *mechanism, s);
  // The page draws a part; memory does not grow with the trajectory.
  if (o.data == "hdf5") request.keep_every = 1 + s.samples / most_drawn;
  request.on_row = [&](const std::vector<double>& row) { return files.write(row); };
  request.from = files.from();
  if (!o.out.empty()) request.between_steps = [&](const auto& make) { files.note(make); };
  ProgressLine line(o.quiet);
  request.progress = [&](double t) {
    line.show(s.form + "  t = " + std::to_string(t) + " s");
    return !interrupted();
  };
  request.going_on = [&] { return !interrupted() && files.problem().empty(); };
  watch_signals();
  StudyResult study;
  {
    // A run checks its time between steps, and one step of a large mechanism may take long: it is
    // stopped half a limit later, at least a second.
    const double more = request.max_cpu_seconds + std::max(1.0, 0.5 * limit);
    const CpuLimit within_steps(limit > 0 ? more : 0, limit - request.max_cpu_seconds);
    study.runs.push_back(run_form(*mechanism, a.start, request));
  }
  RunResult& result = study.runs.front();
  if (!files.flush()) result.status = "failed";
  if (!interrupted())
    time_runs(integrated.mechanism(), integrated.start(), study.runs,
              {.how = timing_named(o.timing),
               .budget = 3,
               .max_cpu_seconds = limit,
               .going_on = {},
               .at_step = request.going_on});
  line.show("");
  study.reference = o.reference.string();
  describe(study, o, *mechanism, a);
  const std::string there = " at t = " + std::to_string(result.stopped_at) + " s";
  if (!files.problem().empty())
    result.reason = there.substr(1) + ": " + files.problem();
  else if (interrupted() && !finished(result))
    result.reason = "interrupted" + there;
  auto json = summary_json(result, study.environment);
  json["assembly"] = {{"moved", a.moved},
                      {"branch", a.branch},
                      {"residue", a.residue},
                      {"rates", replaced_rates_in_words(*mechanism, a.start)}};
  const std::string summary = json.dump(2) + "\n";
  std::vector<ResultFile> others;
  if (!o.out.empty()) others.push_back({o.out / "index.html", run_page(study)});
  if (!o.out.empty() && !mechanism->scene().events.empty())
    others.push_back({o.out / "events.csv", events_csv(result)});
  if (!o.figures.empty()) add_figures(others, figures_of_run(study), o);
  const bool over = files.problem().empty() && (finished(result) || !interrupted());
  const bool written = files.finish(summary, others, over);
  if (o.json) {
    std::fputs(summary.c_str(), stdout);
  } else if (!o.quiet) {
    std::fputs(run_report(study, *mechanism, a).c_str(), stdout);
  }
  for (const std::string& sentence :
       o.quiet ? std::vector<std::string>{} : in_words(result.passed_limits))
    std::fprintf(stderr, "momenta: %s\n", sentence.c_str());
  if (!o.quiet)
    for (const std::string& sentence : result.event_remarks)
      std::fprintf(stderr, "momenta: %s\n", sentence.c_str());
  if (!finished(result))
    std::fprintf(stderr, "momenta: the run stopped: %s\n", result.reason.c_str());
  return written && finished(result) ? done : run_failed;
}

}  // namespace

Verb declare_run(CLI::App& app, Options& o) {
  CLI::App& verb = add_verb(app, "run", "One form, one integrator",
                            "momenta run examples/four_bar/scene.toml --end 20 --out results");
  add_scene(verb, o);
  add_form(verb, o);
  add_run_options(verb, o);
  add_timing(verb, o);
  one_of(verb.add_option("--data", o.data, "Format of the trajectory; reactions too"),
         {"csv", "hdf5"})
      ->capture_default_str();
  verb.add_flag("--reactions", o.reactions, "With the reactions of joints as columns");
  return {&verb, [&o] { return run(o); }, [&o] { return run_equation_file(o); }};
}

}  // namespace momenta::program
