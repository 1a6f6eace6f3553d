#include "results.h"

#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/text/utf8.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/mechanism_view.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/output/run_report.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "loading.h"
#include "progress.h"

namespace momenta::program {

void show(StudyResult& study, const Options& o, const Mechanism& mechanism,
          const Assembly& assembly) {
  for (const std::string& remark : momenta::show(study, mechanism, assembly, o.mesh_bytes))
    if (!o.quiet) std::fprintf(stderr, "momenta: %s: %s\n", o.scene.c_str(), remark.c_str());
}

void describe(StudyResult& study, const Options& o, const Mechanism& mechanism,
              const Assembly& assembly) {
  study.scene = mechanism.scene().name;
  study.scene_file = o.scene.string();
  study.reference = reading::as_utf8(study.reference);
  if (const std::string rates = replaced_rates_in_words(mechanism, assembly.start);
      !rates.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: %s: %s\n", o.scene.c_str(), rates.c_str());
  study.scene_hash = digest(content_of(o.scene));
  study.command = o.command;
  study.plan = plan_lines(mechanism);
  if (!study.runs.empty() && !study.runs.front().integrated.empty())
    study.plan.emplace_back("integrated", study.runs.front().integrated);
  if (!o.out.empty()) show(study, o, mechanism, assembly);
  study.environment = environment();
  if (interrupted() && !study.runs.empty() && study.runs.back().status != "done")
    study.runs.back().reason = "interrupted";
}

int film_intervals_of(const Mechanism& mechanism, const Options& o, std::size_t runs) {
  if (o.out.empty() || mechanism.scene().lagrangian ||
      mechanism.scene().bodies.size() > most_bodies_drawn)
    return 0;
  return film_intervals(picture_of(mechanism), runs);
}

bool is_read(const std::filesystem::path& file, const std::vector<std::filesystem::path>& read) {
  return std::any_of(read.begin(), read.end(), [&](const std::filesystem::path& other) {
    std::error_code none;
    return std::filesystem::equivalent(file, other, none);
  });
}

void expect_inputs_kept(const Options& o) {
  if (o.out.empty()) return;
  for (const char* name :
       {"trajectory.csv", "run.h5",       "study.csv",       "summary.json",   "index.html",
        "runs.jsonl",     "events.csv",   "stress.csv",      "stress.json",    "sweep.csv",
        "sweep.json",     "curves.csv",   "modes.csv",       "statistics.csv", "modes.json",
        "move.csv",       "move.json",    "effort.csv",      "effort.json",    "fit.csv",
        "fit.json",       "fitted.toml",  "bench.csv",       "bench.json",     "linear.json",
        "linear.m",       "linear.py",    "index.json",      "gradient.json",  "gradient.csv",
        "section.csv",    "section.json", "checkpoint.json", "assemblies.csv", "assemblies.json",
        "evaluate.json"})
    if (is_read(o.out / name, o.inputs))
      throw std::invalid_argument("--out " + o.out.string() + ": its " + name +
                                  " is a file that this command reads, expected a directory "
                                  "without it");
}

void expect_own_results(const std::filesystem::path& out, std::string_view own) {
  for (const std::string_view name :
       {"trajectory.csv", "run.h5", "study.csv", "stress.json", "sweep.csv", "modes.csv",
        "move.csv", "effort.csv", "fit.csv", "bench.csv", "linear.json", "gradient.json",
        "assemblies.csv"})
    if (name != own && !(name == "run.h5" && own == "trajectory.csv") && !out.empty() &&
        std::filesystem::exists(out / name))
      throw std::invalid_argument("--out " + out.string() + " holds the " + std::string(name) +
                                  " of another verb; expected a directory of its own");
}

Journal::Study study_of(const Options& o) {
  Journal::Study study{"", build_digest(), o.command};
  for (const auto& file : {o.scene, o.reference, o.reading.loops, std::filesystem::path(o.at)})
    study.digest += digest(content_of(file)) + " ";
  study.digest = digest(study.digest + o.asked);
  return study;
}

std::unique_ptr<Journal> keep_runs(const Options& o, const char* file) {
  if (o.out.empty()) return nullptr;
  auto journal = std::make_unique<Journal>(o.out / file, study_of(o));
  if (!o.quiet && journal->of_another_build())
    std::fprintf(stderr, "momenta: %s is of another build of the program: begun anew\n",
                 journal->file().c_str());
  return journal;
}

void close(Journal* journal, std::size_t runs, bool over, const Options& o) {
  if (!journal) return;
  if (!o.quiet && journal->runs_taken() > 0)
    std::fprintf(stderr, "momenta: %d of %zu runs taken from %s\n", journal->runs_taken(), runs,
                 journal->file().c_str());
  if (!journal->trouble().empty())
    std::fprintf(stderr, "momenta: %s\n", journal->trouble().c_str());
  if (over) journal->remove();
}

bool write_results(const std::vector<ResultFile>& files) {
  CpuLimit::lift();
  const auto problem = atomic_write(files);
  if (problem) std::fprintf(stderr, "momenta: %s\n", problem->c_str());
  return !problem;
}

std::unique_ptr<TrajectoryFile> trajectory_file(const Options& o, const Mechanism& mechanism,
                                                const RunSettings& settings,
                                                std::string_view before) {
  const bool hdf5 = o.data == "hdf5";
  if (hdf5 && !writes_hdf5())
    throw std::invalid_argument(
        "--data hdf5: this program was built without HDF5; expected --data csv, or a build with "
        "MOMENTA_HDF5=ON");
  if (hdf5 && o.out.empty())
    throw std::invalid_argument("--data hdf5: expected --out DIR for run.h5");
  if (o.out.empty()) return nullptr;
  const auto columns = trajectory_columns(mechanism, o.reactions);
  auto file = !hdf5 ? csv_trajectory(o.out / "trajectory.csv", columns, before)
                    : hdf5_trajectory(o.out / "run.h5", columns,
                                      {{"scene", scene_text(mechanism.scene())},
                                       {"command", o.command},
                                       {"settings", key_of(settings)},
                                       {"environment", environment_json(environment()).dump()}});
  if (!file->problem().empty()) throw std::runtime_error(file->problem());
  return file;
}

void expect_place_for_figures(const Options& o) {
  if (!o.figures.empty() && o.out.empty())
    throw std::invalid_argument("--figures " + o.figures + ": expected --out DIR for them");
}

void add_figures(std::vector<ResultFile>& files, std::vector<Figure> figures, const Options& o) {
  for (Figure& figure : figures)
    files.push_back({o.out / "figures" / (figure.name + ".svg"), std::move(figure.svg)});
}

std::string json_text(nlohmann::ordered_json json, const std::string& command) {
  if (!command.empty()) json["command"] = command;
  json["environment"] = environment_json(environment());
  return json.dump(2) + "\n";
}

void tell(const Options& o, const std::string& json, const std::string& table,
          const std::string& file) {
  if (o.json)
    std::fputs(json.c_str(), stdout);
  else if (!o.quiet)
    std::fputs(table.c_str(), stdout);
  if (!file.empty() && !o.out.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: wrote %s\n", (o.out / file).c_str());
}

int publish(const StudyResult& study, const std::string& words, const Options& o, Journal* journal,
            std::vector<ResultFile> files) {
  const std::string json = study_json(study).dump(2) + "\n";
  if (!o.out.empty()) {
    files.push_back({o.out / "summary.json", json});
    files.push_back({o.out / "study.csv", study_csv(study)});
    files.push_back({o.out / "index.html", drift_page(study)});
    if (!o.figures.empty()) add_figures(files, figures_of_study(study), o);
    if (!write_results(files)) return run_failed;
  }
  close(journal, study.runs.size(), !interrupted(), o);
  if (o.json) {
    std::fputs(json.c_str(), stdout);
  } else if (!o.quiet) {
    std::printf("%s\n%s", drift_table(study).c_str(), words.c_str());
    std::fputs(integrated_in_words(study).c_str(), stdout);
  }
  if (!o.out.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "index.html").c_str());
  const bool any = std::any_of(study.runs.begin(), study.runs.end(),
                               [](const auto& r) { return r.status == "done"; });
  return any && !interrupted() ? done : run_failed;
}

}  // namespace momenta::program
