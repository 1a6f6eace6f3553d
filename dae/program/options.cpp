#include "options.h"

#include <momenta/core/scene/files/read_scene.h>
#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/dae/equations/holds_equations.h>
#include <momenta/dae/report/atomic_write.h>
#include <momenta/dae/report/csv.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/report/picture_data.h>
#include <momenta/dae/report/still.h>
#include <momenta/dae/report/table.h>
#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/motion.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/study/state_input.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "cpu_limit.h"
#include "values.h"

namespace momenta::program {
namespace {

volatile std::sig_atomic_t signal_came = 0;
extern "C" void take_signal(int) {
  signal_came = 1;
}

}  // namespace

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void add_scene_file(CLI::App& verb, Options& o, bool required) {
  verb.add_option("scene", o.scene, "TOML, URDF (.urdf), MJCF (.xml, .mjcf) or SDF (.sdf)")
      ->required(required)
      ->type_name("SCENE");
  verb.add_option("--loops", o.reading.loops, "Of a URDF: its loops (default: the .yaml beside it)")
      ->type_name("FILE");
  verb.add_flag("--free-root", o.reading.free_root, "Of a URDF: the root link floats");
  verb.add_option("--set", o.set, "PLACE=NUMBER in place of the scene's; repeatable")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  verb.add_option("--control", o.reading.controls, "Of an MJCF: actuators act; start at a <key>")
      ->type_name("CONTROL")
      ->allow_extra_args(false);
  verb.add_option("--key", o.reading.key, "Of an MJCF: start at this <key>, by name or number")
      ->type_name("KEY");
  verb.add_option("--stops", o.stops, "Limits push back: STIFFNESS[,DAMPING], SI units")
      ->type_name("STIFFNESS");
  verb.add_option("--at", o.at, "Start values: JSON {\"q\": {..}, \"v\": {..}}, or its file")
      ->type_name("STATE");
}

void add_scene(CLI::App& verb, Options& o) {
  add_scene_file(verb, o);
  one_of(verb.add_option("--algebra", o.algebra, "Kernel (default: auto)"),
         {"auto", "planar", "spatial"});
  one_of(verb.add_option("--kkt", o.kkt, "Solver of the loop equations (default: auto)"),
         {"auto", "sweeps", "sparse", "dense"});
  one_of(verb.add_option("--cut", o.cut, "What runs integrate (default: auto, the least work)"),
         {"auto", "scene"});
  add_level(verb, o);
  verb.add_flag("--json", o.json, "JSON on standard output; no progress, no table");
  verb.add_flag("--quiet", o.quiet, "No progress, no table");
}

void add_level(CLI::App& verb, Options& o) {
  one_of(verb.add_option("--level", o.level, "x86-64 level of the kernels (default: best)"),
         {"1", "3", "4"});
}

void add_timing(CLI::App& verb, Options& o) {
  one_of(verb.add_option("--timing", o.timing, "How runs are timed"), {"rounds", "once", "none"})
      ->capture_default_str();
}

void add_run_options(CLI::App& verb, Options& o, const char* cpu_limit) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators()) names.push_back(i.name);
  one_of(verb.add_option("--integrator", o.integrator,
                         "Default: ida, or dp5, dop853, vern9 by --rtol"),
         names)
      ->type_name("INTEGRATOR");
  verb.add_option("--gauge", o.gauge, "How momentum forms keep σ small [1/s]")
      ->type_name("none|reset|flip|leak|leak:RATE");
  positive(verb.add_option("--rtol", o.rtol, "Relative, absolute tolerance"), "X")
      ->capture_default_str();
  positive(
      verb.add_option("--atol", o.atol, "Absolute tolerance, scaled per unknown (default: rtol)"),
      "X");
  positive(verb.add_option("--step", o.step, "Step of the fixed-step integrators [s]"), "S");
  within(verb.add_option("--spectral-radius", o.spectral_radius, "Of generalised-alpha, below 1"),
         "X", 0.0, 1.0)
      ->capture_default_str();
  positive(verb.add_option("--end", o.end, "End time [s]; output intervals"), "S");
  within(verb.add_option("--samples", o.samples, "Output intervals"), "N", 1, most_samples);
  auto* project =
      verb.add_flag("--project", o.project, "Correct positions after each step, or not");
  verb.add_flag("--no-project", o.no_project, "No correction, even if the scene asks for it")
      ->excludes(project);
  positive(
      verb.add_option("--baumgarte-alpha", o.baumgarte_alpha, "α, β of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]"),
      "X");
  positive(verb.add_option("--baumgarte-beta", o.baumgarte_beta, "β of it [1/s]"), "X");
  positive(verb.add_option("--beta", o.beta, "Momentum forms: Φ̇ = −βΦ [1/s] (default: 0)"), "X");
  positive(verb.add_option("--penalty", o.penalty, "Of augmented Lagrangians (default: 1e7)"), "X");
  positive(verb.add_option("--cpu-limit", o.cpu_limit,
                           std::string("CPU time of a run [s] (default: ") + cpu_limit + ")"),
           "S");
  verb.add_option("--reference", o.reference, "CSV with a reference solution")->type_name("FILE");
  add_results(verb, o);
}

void add_cpu_limit(CLI::App& verb, Options& o, const char* usual) {
  positive(verb.add_option("--cpu-limit", o.cpu_limit,
                           std::string("CPU time of all of it [s] (default: ") + usual + ")"),
           "S");
}

void add_mesh_bytes(CLI::App& verb, Options& o) {
  within(verb.add_option("--mesh-bytes", o.mesh_bytes, "Of meshes in a page; 0: none"), "N", 0,
         1'000'000'000)
      ->capture_default_str();
}

void add_results(CLI::App& verb, Options& o) {
  verb.add_option("--out", o.out, "Directory for results; bytes of meshes in a page")
      ->type_name("DIR");
  add_mesh_bytes(verb, o);
  one_of(verb.add_option("--figures", o.figures, "Every chart for papers, in DIR/figures"),
         {"svg"});
}

std::vector<Setting> settings_of(const Options& o) {
  std::vector<Setting> settings;
  for (const std::string& text : o.set) {
    const std::size_t equals = text.rfind('=');
    Setting setting{text.substr(0, equals), 0};
    const char* end = text.data() + text.size();
    const char* begin = equals == text.npos ? end : text.data() + equals + 1;
    const auto [read, error] = std::from_chars(begin, end, setting.value);
    if (equals == 0 || begin == end || error != std::errc{} || read != end ||
        !std::isfinite(setting.value))
      throw std::invalid_argument("--set '" + text +
                                  "': expected PLACE=NUMBER, as in body.crank.mass=2 or, of a "
                                  "parameter, a=0.6");
    settings.push_back(setting);
  }
  return settings;
}

namespace {

/// --stops. @throws std::invalid_argument
std::optional<std::array<double, 2>> stops_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::array<double, 2> stops{0, 0};
  const char *at = text.data(), *end = at + text.size();
  bool good = true;
  for (std::size_t i = 0; i < 2 && good && at != nullptr; ++i) {
    const auto [stop, error] = std::from_chars(at, end, stops[i]);
    good = error == std::errc{} && stops[i] >= 0 && std::isfinite(stops[i]) &&
           (stop == end || (*stop == ',' && i == 0));
    at = good && stop != end ? stop + 1 : nullptr;
  }
  if (!good || !(stops[0] > 0))
    throw std::invalid_argument("--stops '" + text +
                                "': expected STIFFNESS or STIFFNESS,DAMPING, numbers >= 0, as in "
                                "1e4,100");
  return stops;
}

}  // namespace

Scene read(const Options& o) {
  ReadOptions reading = o.reading;
  reading.stops = stops_of(o.stops);
  Scene scene = read_scene(o.scene, reading, settings_of(o));
  if (!o.at.empty()) start_at(o.at, scene);
  if (!o.quiet)
    for (const std::string& remark : scene.remarks)
      std::fprintf(stderr, "momenta: %s: %s\n", o.scene.c_str(), remark.c_str());
  return scene;
}

MechanismOptions mechanism_options(const Options& o) {
  MechanismOptions options;
  options.algebra = o.algebra == "planar"    ? Algebra::planar
                    : o.algebra == "spatial" ? Algebra::spatial
                                             : Algebra::automatic;
  options.kkt = o.kkt == "dense"    ? KktChoice::dense
                : o.kkt == "sweeps" ? KktChoice::sweeps
                : o.kkt == "sparse" ? KktChoice::sparse
                                    : KktChoice::automatic;
  options.cut = o.cut == "scene" ? CutChoice::scene : CutChoice::automatic;
  return options;
}

bool names_equations(const Options& o) {
  std::error_code error;
  return o.scene.extension() == ".toml" && std::filesystem::is_regular_file(o.scene, error) &&
         holds_equations(content_of(o.scene));
}

std::unique_ptr<Mechanism> load(const Options& o) {
  expect_place_for_figures(o);
  return std::make_unique<Mechanism>(read(o), mechanism_options(o));
}

RunSettings run_settings(const Options& o, const RunDefaults& defaults) {
  RunSettings s = default_settings(defaults, o.form, o.integrator, o.rtol);
  if (!o.gauge.empty()) s.gauge = o.gauge;
  s.atol = o.atol.value_or(s.atol);
  s.step = o.step.value_or(s.step);
  s.spectral_radius = o.spectral_radius;
  s.end_time = o.end.value_or(s.end_time);
  s.samples = o.samples.value_or(s.samples);
  s.project = o.project || (s.project && !o.no_project);
  s.baumgarte_alpha = o.baumgarte_alpha;
  s.baumgarte_beta = o.baumgarte_beta;
  s.beta = o.beta;
  s.penalty = o.penalty;
  return s;
}

std::unique_ptr<Reference> load_reference(const Options& o, const Mechanism& mechanism) {
  if (o.reference.empty()) return nullptr;
  auto reference = std::make_unique<Reference>(o.reference);
  reference->bind(trajectory_columns(mechanism, o.reactions));
  return reference;
}

void show(StudyResult& study, const Options& o, const Mechanism& mechanism,
          const Assembly& assembly) {
  for (const std::string& remark : momenta::show(study, mechanism, assembly, o.mesh_bytes))
    if (!o.quiet) std::fprintf(stderr, "momenta: %s: %s\n", o.scene.c_str(), remark.c_str());
}

void describe(StudyResult& study, const Options& o, const Mechanism& mechanism,
              const Assembly& assembly) {
  study.scene = mechanism.scene().name;
  study.scene_file = o.scene.string();
  study.scene_hash = digest(content_of(o.scene));
  study.command = o.command;
  study.plan = mechanism.plan_lines();
  if (!study.runs.empty() && !study.runs.front().integrated.empty())
    study.plan.emplace_back("integrated", study.runs.front().integrated);
  if (!o.out.empty()) show(study, o, mechanism, assembly);
  study.environment = environment();
  if (interrupted() && !study.runs.empty() && study.runs.back().status != "done")
    study.runs.back().reason = "interrupted";
}

void print_integrated(const StudyResult& study) {
  if (!study.runs.empty() && !study.runs.front().integrated.empty())
    std::printf(
        "\nIntegrated in place of the scene as written, for less work: %s (--cut scene: as "
        "written)\n",
        study.runs.front().integrated.c_str());
}

int film_intervals_of(const Mechanism& mechanism, const Options& o, std::size_t runs) {
  if (o.out.empty() || mechanism.scene().lagrangian ||
      mechanism.scene().bodies.size() > most_bodies_drawn)
    return 0;
  return film_intervals(picture_of(mechanism), runs);
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  std::stringstream in(list);
  for (std::string name; std::getline(in, name, ',');) names.push_back(name);
  return names;
}

std::vector<std::pair<std::string, double>> amounts_in(const std::string& option,
                                                       const std::string& list,
                                                       const std::string& like) {
  std::vector<std::pair<std::string, double>> all;
  for (const std::string& part : names_in(list)) {
    const std::size_t equals = part.find('=');
    double amount = 1;
    if (equals != std::string::npos) {
      const char *begin = part.data() + equals + 1, *end = part.data() + part.size();
      const auto [read, error] = std::from_chars(begin, end, amount);
      if (error != std::errc{} || read != end || !std::isfinite(amount) || amount == 0)
        throw std::invalid_argument(option + " '" + list +
                                    "': expected NAME or NAME=AMOUNT, amounts other than zero, as "
                                    "in " +
                                    like);
    }
    all.emplace_back(part.substr(0, equals), amount);
  }
  return all;
}

void expect_own_results(const std::filesystem::path& out, std::string_view own) {
  for (const std::string_view name :
       {"trajectory.csv", "run.h5", "study.csv", "stress.json", "sweep.csv", "modes.csv",
        "move.csv", "effort.csv", "fit.csv", "bench.csv", "linear.json", "gradient.json"})
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
    print_integrated(study);
  }
  if (!o.out.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "index.html").c_str());
  const bool any = std::any_of(study.runs.begin(), study.runs.end(),
                               [](const auto& r) { return r.status == "done"; });
  return any && !interrupted() ? done : run_failed;
}

bool interrupted() {
  return signal_came != 0;
}

void watch_signals() {
  struct sigaction once {};
  once.sa_handler = take_signal;
  once.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int number : {SIGINT, SIGTERM}) ::sigaction(number, &once, nullptr);
}

ProgressLine::ProgressLine(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) != 0) {}
ProgressLine::~ProgressLine() {
  if (active_) std::fputs("\r\x1b[K", stderr);
}
bool ProgressLine::going(int number, int total, const std::string& label, double fraction) {
  show("[" + std::to_string(number) + "/" + std::to_string(total) + "] " + label + "  " +
       std::to_string(static_cast<int>(100 * fraction)) + " %");
  return !interrupted();
}
void ProgressLine::show(const std::string& text) {
  if (active_) std::fprintf(stderr, "\r%.100s\x1b[K", text.c_str());
}

}  // namespace momenta::program
