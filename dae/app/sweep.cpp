#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/sample_report.h>
#include <momenta/dae/output/sweep_report.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/run_record.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <mutex>
#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "ranks.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct SweepOptions {
  std::vector<std::string> vary;
  std::string watch;   ///< comma-separated
  std::string sample;  ///< random, latin or sobol; empty: all combinations
  std::optional<std::size_t> points;
  std::optional<std::uint64_t> seed;
  bool indices = false;
  std::string task;  ///< I/N; empty: all cases
  int threads = 0;   ///< 0: one for each processor, of one process
};

/// Keys of cases, unique to a study.
class Keys {
 public:
  Keys(const Options& o, const SweepRequest& request) : study_(digest(request.text + o.asked)) {}
  std::string of(std::size_t number) const {
    return "case " + std::to_string(number) + " of " + study_;
  }

 private:
  std::string study_;
};

/// Cases whose number modulo `tasks` is `first`.
struct Task {
  std::size_t first = 0, tasks = 1;

  /// "3/100": I from 1 to N. @throws std::invalid_argument
  explicit Task(const std::string& text) {
    if (text.empty()) return;
    const char* end = text.data() + text.size();
    const auto [slash, error] = std::from_chars(text.data(), end, first);
    bool good = error == std::errc{} && slash != end && *slash == '/';
    if (good) {
      const auto [stop, second] = std::from_chars(slash + 1, end, tasks);
      good = second == std::errc{} && stop == end && first >= 1 && first <= tasks;
    }
    if (!good)
      throw std::invalid_argument("--task '" + text +
                                  "': expected I/N, I from 1 to N, as in 3/100");
    --first;
  }
  bool has(std::size_t number) const { return number % tasks == first; }
  std::string file() const {
    return "task-" + std::to_string(first + 1) + "-of-" + std::to_string(tasks) + ".jsonl";
  }
};

/// Journals of this study's tasks in its directory. @throws std::invalid_argument
std::vector<std::unique_ptr<Journal>> parts_in(const Options& o) {
  std::vector<std::unique_ptr<Journal>> parts;
  if (o.out.empty() || !std::filesystem::is_directory(o.out)) return parts;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(o.out))
    if (const std::string name = entry.path().filename().string();
        name.starts_with("task-") && name.ends_with(".jsonl"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    if (Journal::build_of(file) != build_digest())
      throw std::invalid_argument(file.string() +
                                  " was made by another build or on another processor, whose "
                                  "numbers may differ; expected tasks of one build on processors "
                                  "of one kind, or the file removed");
    parts.push_back(std::make_unique<Journal>(file, study_of(o)));
  }
  return parts;
}

/// Removes files of an earlier sample that this study did not rewrite.
void remove_other_statistics(const std::filesystem::path& out,
                             const std::vector<ResultFile>& written) {
  const bool sampled = std::filesystem::exists(out / "statistics.csv");
  for (const char* name : {"statistics.csv", "curves.csv", "index.html"})
    if (sampled && std::none_of(written.begin(), written.end(),
                                [&](const ResultFile& file) { return file.path == out / name; }))
      std::filesystem::remove(out / name);
}

/// Records of finished cases by number; several threads may keep them.
class Finished {
 public:
  Finished(std::size_t count, Keys of_cases, Journal* journal, ProgressLine& line)
      : cases_(count), keys_(std::move(of_cases)), journal_(journal), line_(line) {}

  /// Takes records of journal and parts; returns the task's other numbers.
  std::vector<std::size_t> wanted(const Task& task,
                                  const std::vector<std::unique_ptr<Journal>>& parts) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      if (!task.has(i)) continue;
      ++asked_;
      auto known = recall<SweepCase>(journal_, keys_.of(i));
      for (std::size_t k = 0; k < parts.size() && !known; ++k)
        known = recall<SweepCase>(parts[k].get(), keys_.of(i));
      if (known) {
        cases_[i] = std::move(*known);
        ++count_;
      } else {
        numbers.push_back(i);
      }
    }
    return numbers;
  }
  void keep(std::size_t number, const std::string& text) {
    const auto record = nlohmann::json::parse(text);
    SweepCase made;
    if (!read_record(record, made)) throw std::runtime_error("a case came back damaged");
    if (interrupted() && made.status == "failed") return;  // stopped half-way
    if (journal_) journal_->add(keys_.of(number), record);
    const std::lock_guard lock(turn_);
    cases_[number] = std::move(made);
    ++count_;
    line_.show("[" + std::to_string(count_) + "/" + std::to_string(asked_) + "] cases");
  }
  bool complete() const { return count_ == asked_; }
  std::size_t asked() const { return asked_; }
  std::size_t count() const { return count_; }
  const std::vector<SweepCase>& cases() const { return cases_; }

 private:
  std::vector<SweepCase> cases_;
  Keys keys_;
  std::size_t asked_ = 0, count_ = 0;
  Journal* journal_;
  ProgressLine& line_;
  std::mutex turn_;
};

/// The scene as TOML: its own text, whose omissions may vary too, or converted from another format
/// or start.
void take_scene(const Options& o, SweepRequest& request) {
  const Scene scene = read(o);
  const bool own = is_toml(o.scene) && o.at.empty();
  request.text = own ? reading::text_of(o.scene) : scene_text(scene);
  if (own) request.fixed = settings_of(o);
}

int sweep(const Options& o, const SweepOptions& s) {
  Ranks ranks;
  watch_signals();
  SweepRequest request;
  take_scene(o, request);
  request.file = o.scene.string();
  request.mechanism = mechanism_options(o);
  for (const std::string& text : s.vary) request.varied.emplace_back(text);
  if (const auto settings = sample_settings(s.sample, s.points, s.seed, s.indices))
    request.sample = std::make_shared<Sample>(*settings, request.varied.size());
  request.watched = names_in(s.watch);
  const Task task(s.task);
  if (!s.task.empty() && o.out.empty())
    throw std::invalid_argument("--task " + s.task +
                                ": expected --out DIR, the same for all tasks");
  request.max_cpu_seconds = o.cpu_limit.value_or(0);
  request.settings = [&](const RunDefaults& defaults) { return run_settings(o, defaults); };
  request.going_on = [] { return !interrupted(); };
  const std::size_t count = request.cases();
  const auto make = [&](std::size_t number) { return record_of(run_case(request, number)).dump(); };
  if (ranks.rank() > 0) {
    if (ranks.agreed(true)) ranks.share({}, 1, make, {}, {});
    return done;
  }
  std::unique_ptr<Journal> journal;
  std::vector<std::unique_ptr<Journal>> parts;
  try {
    expect_own_results(o.out, "sweep.csv");
    if (s.task.empty()) parts = parts_in(o);
    journal = keep_runs(o, s.task.empty() ? "runs.jsonl" : task.file().c_str());
  } catch (...) {
    ranks.agreed(false);
    throw;
  }
  ranks.agreed(true);
  ProgressLine line(o.quiet);
  Finished finished(count, Keys(o, request), journal.get(), line);
  const int threads = s.threads == 0 && ranks.count() > 1 ? 1 : threads_of(s.threads);
  ranks.share(
      finished.wanted(task, parts), threads, make,
      [&](std::size_t number, const std::string& record) { finished.keep(number, record); },
      [] { return !interrupted(); });
  line.show("");
  if (!finished.complete()) {
    close(journal.get(), finished.count(), false, o);
    std::fprintf(stderr, "momenta: stopped after %zu of %zu cases%s\n", finished.count(),
                 finished.asked(), journal ? "; the same command goes on from there" : "");
    return run_failed;
  }
  if (!s.task.empty()) {
    close(journal.get(), finished.count(), false, o);
    if (!o.quiet)
      std::fprintf(
          stderr,
          "momenta: task %s: %zu of %zu cases are in %s; once all tasks are done, the same "
          "command without --task joins them\n",
          s.task.c_str(), finished.count(), count, journal->file().c_str());
    return journal->trouble().empty() ? done : run_failed;
  }
  std::optional<SweepStatistics> statistics;
  if (request.sample) statistics = sweep_statistics(request, finished.cases());
  const SweepStatistics* told = statistics ? &*statistics : nullptr;
  auto json = sweep_json(request, finished.cases(), told);
  json["command"] = o.command;
  json["processes"] = ranks.count();
  json["threads"] = threads;
  json["environment"] = environment_json(environment());
  const std::string summary = json.dump(2) + "\n";
  if (!o.out.empty()) {
    std::vector<ResultFile> files{{o.out / "sweep.csv", sweep_csv(request, finished.cases())},
                                  {o.out / "sweep.json", summary}};
    if (told) {
      files.push_back({o.out / "statistics.csv", statistics_csv(request, *told)});
      if (!told->curves.empty()) files.push_back({o.out / "curves.csv", curves_csv(*told)});
      files.push_back({o.out / "index.html",
                       sample_page(request, *told, finished.cases(), environment(), o.command)});
    }
    if (!write_results(files)) return run_failed;
    remove_other_statistics(o.out, files);
  }
  close(journal.get(), count, true, o);
  int of_tasks = 0;
  for (const auto& part : parts) {
    of_tasks += part->runs_taken();
    part->remove();
  }
  if (!parts.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: %d of %zu runs taken from %zu tasks\n", of_tasks, count,
                 parts.size());
  tell(o, summary, sweep_table(request, finished.cases(), told), told ? "index.html" : "");
  const bool any = std::any_of(finished.cases().begin(), finished.cases().end(),
                               [](const SweepCase& c) { return c.status == "done"; });
  return any ? done : run_failed;
}

}  // namespace

Verb declare_sweep(CLI::App& app, Options& o) {
  const auto own = std::make_shared<SweepOptions>();
  CLI::App& verb =
      add_verb(app, "sweep", "One run for each combination of numbers of the scene",
               "momenta sweep examples/four_bar/scene.toml --vary body.crank.mass=1,2");
  add_scene(verb, o);
  verb.add_option("--vary", own->vary, "a=1,2 or a=0:9:4[:log], sampled a=0:9, a=normal:5:1")
      ->type_name("PLACE=VALUES")
      ->required();
  one_of(verb.add_option("--sample", own->sample, "Points instead of combinations (256)"),
         {"random", "latin", "sobol"});
  within(verb.add_option("--points", own->points, "Of a sample (default: 256)"), "N",
         std::size_t{1}, std::size_t{10'000'000});
  verb.add_option("--seed", own->seed, "Of the sample (1); with Sobol indices")->type_name("N");
  verb.add_flag("--indices", own->indices,
                "Sobol indices too, from points times quantities + 2 cases");
  verb.add_option("--watch", own->watch, "Columns of the trajectory: last, least and greatest")
      ->type_name("COLUMN,...");
  add_form(verb, o);
  add_run_options(verb, o);
  without(verb, {"--reference", "--figures"});
  within(verb.add_option("--threads", own->threads,
                         "Default: one a processor, under MPI 1; part of cases"),
         "N", 1, 1024);
  verb.add_option("--task", own->task,
                  "Part I of N of the cases, kept in --out; without it: joined")
      ->type_name("I/N");
  return {&verb, [&o, own] { return sweep(o, *own); }};
}

}  // namespace momenta::program
