#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/dae/report/json.h>
#include <momenta/dae/report/sweep_report.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/run_record.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "options.h"
#include "ranks.h"

namespace momenta::program {
namespace {

/// Keys of a study's cases: other studies have others.
class Keys {
 public:
  Keys(const Options& o, const SweepRequest& request) : study_(digest(request.text + o.asked)) {}
  std::string of(std::size_t number) const {
    return "case " + std::to_string(number) + " of " + study_;
  }

 private:
  std::string study_;
};

/// Records of finished cases by number; several threads may keep them.
class Finished {
 public:
  Finished(std::size_t count, Keys of_cases, Journal* journal, ProgressLine& line)
      : cases_(count), keys_(std::move(of_cases)), journal_(journal), line_(line) {}

  /// Takes what the journal has; the numbers of all others.
  std::vector<std::size_t> wanted() {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < cases_.size(); ++i)
      if (auto known = recall<SweepCase>(journal_, keys_.of(i))) {
        cases_[i] = std::move(*known);
        ++count_;
      } else {
        numbers.push_back(i);
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
    line_.show("[" + std::to_string(count_) + "/" + std::to_string(cases_.size()) + "] cases");
  }
  bool complete() const { return count_ == cases_.size(); }
  std::size_t count() const { return count_; }
  const std::vector<SweepCase>& cases() const { return cases_; }

 private:
  std::vector<SweepCase> cases_;
  Keys keys_;
  std::size_t count_ = 0;
  Journal* journal_;
  ProgressLine& line_;
  std::mutex turn_;
};

/// The scene as TOML: its own text, so that what it leaves out may be varied too, or, of another
/// format or started elsewhere, the text it converts to.
void take_scene(const Options& o, SweepRequest& request) {
  const Scene scene = read(o);
  const bool own = is_toml(o.scene) && o.at.empty();
  request.text = own ? reading::text_of(o.scene) : scene_text(scene);
  if (own) request.fixed = settings_of(o);
}

}  // namespace

int sweep(const Options& o, const SweepOptions& s) {
  Ranks ranks;
  watch_signals();
  SweepRequest request;
  take_scene(o, request);
  request.file = o.scene.string();
  request.mechanism = mechanism_options(o);
  for (const std::string& text : s.vary) request.varied.emplace_back(text);
  request.watched = names_in(s.watch);
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
  try {
    expect_own_results(o.out, "sweep.csv");
    journal = keep_runs(o);
  } catch (...) {
    ranks.agreed(false);
    throw;
  }
  ranks.agreed(true);
  ProgressLine line(o.quiet);
  Finished finished(count, Keys(o, request), journal.get(), line);
  const int alone = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int threads = s.threads > 0 ? s.threads : ranks.count() > 1 ? 1 : alone;
  ranks.share(
      finished.wanted(), threads, make,
      [&](std::size_t number, const std::string& record) { finished.keep(number, record); },
      [] { return !interrupted(); });
  line.show("");
  if (!finished.complete()) {
    close(journal.get(), finished.count(), false, o);
    std::fprintf(stderr, "momenta: stopped after %zu of %zu cases%s\n", finished.count(), count,
                 journal ? "; the same command goes on from there" : "");
    return run_failed;
  }
  auto json = sweep_json(request, finished.cases());
  json["command"] = o.command;
  json["processes"] = ranks.count();
  json["threads"] = threads;
  json["environment"] = environment_json(environment());
  const std::string summary = json.dump(2) + "\n";
  if (!o.out.empty() && !write_results({{o.out / "sweep.csv", sweep_csv(request, finished.cases())},
                                        {o.out / "sweep.json", summary}}))
    return run_failed;
  close(journal.get(), count, true, o);
  tell(o, summary, sweep_table(request, finished.cases()));
  const bool any = std::any_of(finished.cases().begin(), finished.cases().end(),
                               [](const SweepCase& c) { return c.status == "done"; });
  return any ? done : run_failed;
}

}  // namespace momenta::program
