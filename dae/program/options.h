#pragma once
// What the verbs share: the scene, common options, messages and the exit status.

#include <momenta/core/scene/files/read_scene.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/report/atomic_write.h>
#include <momenta/dae/report/figure.h>
#include <momenta/dae/report/json.h>
#include <momenta/dae/report/meshes.h>
#include <momenta/dae/report/trajectory_file.h>
#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/run_form.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace momenta::program {

inline constexpr int done = 0, run_failed = 1, bad_input = 2;

struct Options {
  std::string command;  ///< as typed
  std::string asked;    ///< the verb and its options, but for where and how results are told
  std::vector<std::string> given;  ///< names of the options that were given
  std::filesystem::path scene;
  ReadOptions reading;           ///< what a URDF does not say
  std::vector<std::string> set;  ///< numbers in place of the scene's: PLACE=NUMBER
  std::string stops;             ///< at limits: STIFFNESS[,DAMPING]; empty: none
  std::string at;                ///< start values in place of the scene's; empty: its own
  std::string algebra = "auto", kkt = "auto", cut = "auto";
  std::string level;  ///< of the kernels; empty: the machine's best, or MOMENTA_LEVEL
  std::string form = "momentum", integrator, gauge;
  double rtol = 1e-8;
  std::optional<double> atol, step, end;
  std::optional<int> samples;
  double spectral_radius = 0.8;
  double baumgarte_alpha = 0, baumgarte_beta = 0;
  double beta = 0, penalty = 0;
  bool project = false, no_project = false;  ///< neither: as the scene says
  std::optional<double> cpu_limit;
  std::string timing = "rounds";
  std::filesystem::path reference, out;
  std::string figures;                        ///< svg or none
  std::string data = "csv";                   ///< of run: csv or hdf5
  bool reactions = false;                     ///< of run: those of joints are columns
  std::size_t mesh_bytes = usual_mesh_bytes;  ///< of a page
  bool json = false, quiet = false;
};

void add_scene(CLI::App& verb, Options& o);
/// The scene alone, with what a URDF does not say.
void add_scene_file(CLI::App& verb, Options& o, bool required = true);
void add_level(CLI::App& verb, Options& o);
/// Of verbs that time what they ran.
void add_timing(CLI::App& verb, Options& o);
/// `cpu_limit`: that of a run of this verb, in words.
void add_run_options(CLI::App& verb, Options& o, const char* cpu_limit = "none");
void add_results(CLI::App& verb, Options& o);
/// Of verbs without runs (cpu_limit.h); `usual`: theirs, in words.
void add_cpu_limit(CLI::App& verb, Options& o, const char* usual = "none");
/// Of verbs that write pages.
void add_mesh_bytes(CLI::App& verb, Options& o);

/// --set. @throws std::invalid_argument
std::vector<Setting> settings_of(const Options& o);
MechanismOptions mechanism_options(const Options& o);
/// Reads the scene, and tells what its reader remarked unless --quiet is given.
Scene read(const Options& o);
std::unique_ptr<Mechanism> load(const Options& o);
/// The run that is asked for, of a scene with these defaults.
RunSettings run_settings(const Options& o, const RunDefaults& defaults);
/// The reference, bound to the mechanism's columns; empty when none is asked for.
std::unique_ptr<Reference> load_reference(const Options& o, const Mechanism& mechanism);

/// What a study tells of its scene, its command and the machine; and that it was interrupted.
void describe(StudyResult& study, const Options& o, const Mechanism& mechanism,
              const Assembly& assembly);

/// The picture of a study, as show() makes it, and what it leaves out told unless --quiet is given.
void show(StudyResult& study, const Options& o, const Mechanism& mechanism,
          const Assembly& assembly);

/// Prints what its runs integrated in place of the scene as written, if that is another one.
void print_integrated(const StudyResult& study);

/// Intervals of the film of one of so many runs; 0 without --out and where nothing is drawn.
int film_intervals_of(const Mechanism& mechanism, const Options& o, std::size_t runs);

/// "a,b,c" as a list.
std::vector<std::string> names_in(const std::string& list);

/// "A", or "A=1,B=-0.5": names and amounts other than zero, 1 where none stands. `like`: what was
/// expected. @throws std::invalid_argument
std::vector<std::pair<std::string, double>> amounts_in(const std::string& option,
                                                       const std::string& list,
                                                       const std::string& like);

/// Writes result files, all or none; on failure prints the sentence and returns false.
bool write_results(const std::vector<ResultFile>& files);

/// The run's trajectory, where --out asks for one, as text, which begins with `before`, or as HDF5.
/// @throws std::invalid_argument; std::runtime_error where it cannot be written
std::unique_ptr<TrajectoryFile> trajectory_file(const Options& o, const Mechanism& mechanism,
                                                const RunSettings& settings,
                                                std::string_view before);

/// Where figures are asked for there must be a place for them. @throws std::invalid_argument
void expect_place_for_figures(const Options& o);
/// Adds them, as files of figures/ where --out says.
void add_figures(std::vector<ResultFile>& files, std::vector<Figure> figures, const Options& o);

/// The JSON document with --json, else, unless --quiet is given, the table on standard output; and
/// which file of --out to look at, where one is named.
void tell(const Options& o, const std::string& json, const std::string& table,
          const std::string& file = "");

/// The bytes of a file; empty where there is none.
std::string content_of(const std::filesystem::path& file);
/// What was asked, and which program was.
Journal::Study study_of(const Options& o);
/// Finished runs of this study, kept beside its results until it is over; null without --out.
std::unique_ptr<Journal> keep_runs(const Options& o, const char* file = "runs.jsonl");

/// Writes a study's files, `files` among them, where --out says, prints its table and `words`, or
/// its JSON, and returns the exit status.
int publish(const StudyResult& study, const std::string& words, const Options& o, Journal* journal,
            std::vector<ResultFile> files = {});

/// Refuses a directory that holds results of another verb than the one that writes `own`.
/// @throws std::invalid_argument
void expect_own_results(const std::filesystem::path& out, std::string_view own);
/// Says how many runs were taken from the journal and what is amiss with it; removes it where the
/// study is over and written.
void close(Journal* journal, std::size_t runs, bool over, const Options& o);

/// From now on SIGINT and SIGTERM are noted, for verbs that look whether one came; a second one of
/// its kind ends the program where it stands.
void watch_signals();
/// True once one came: runs stop at their next step and keep what they have.
bool interrupted();

/// One line on standard error that rewrites itself on a terminal, and stays silent elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  void show(const std::string& text);
  /// Shows where a study is; false once it is interrupted.
  bool going(int number, int total, const std::string& label, double fraction);

 private:
  bool active_;
};

int check(const Options& o);
int assemble_verb(const Options& o);
struct AssembliesOptions {
  std::string hold;  ///< comma-separated
  int starts = 1000;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one for each processor
  std::string by = "search";
};
/// `assemble --all`
int assemblies(const Options& o, const AssembliesOptions& a);
int run(const Options& o);
/// The page of the assembled mechanism: a file with --out, else on standard output.
int view(const Options& o);
struct DriftOptions {
  std::string forms;  ///< comma-separated; empty: all
};
int drift(const Options& o, const DriftOptions& d);
struct WorkOptions {
  std::string forms, integrators;  ///< comma-separated; empty: all forms, dop853
  double loosest = 1e-4, tightest = 1e-12;
  double per_decade = 1;
  int step_rungs = 6;         ///< of a ladder of fixed steps, each half of the last
  bool no_reference = false;  ///< judge by drift alone
  bool orders = false;        ///< print observed orders in place of the conclusion
};
int work(const Options& o, const WorkOptions& w);
/// 1e-4, 1e-5, … through the tolerances asked for. @throws std::invalid_argument
std::vector<double> tolerance_rungs(const WorkOptions& w);
struct StressOptions {
  std::string forms, integrators, along;  ///< comma-separated; empty: the usual ones, all ladders
  double within = 1e-3;
  double reference_seconds = 10;
  int threads = 0;  ///< 0: one for each processor
};
/// Without a scene: the built-in ladders.
int stress(const Options& o, const StressOptions& options);
struct SectionOptions {
  std::string when, axes, starts, led;
  bool up = false, down = false;
};
int section(const Options& o, const SectionOptions& s);

struct SweepOptions {
  std::vector<std::string> vary;
  std::string watch;   ///< comma-separated
  std::string sample;  ///< random, latin or sobol; empty: every combination
  std::optional<std::size_t> points;
  std::optional<std::uint64_t> seed;
  bool indices = false;
  std::string task;  ///< I/N; empty: all cases
  int threads = 0;   ///< 0: one for each processor, of one process
};
int sweep(const Options& o, const SweepOptions& s);
struct ModesOptions {
  std::string equilibrium = "settle";  ///< settle, nearest, start or steady
  std::string drives = "held";         ///< held or running
  std::optional<int> count;
};
int modes(const Options& o, const ModesOptions& m);
struct LineariseOptions {
  std::string kind = "minimal";              ///< minimal or descriptor
  std::string state;                         ///< as for evaluate; empty: the start
  std::optional<double> time, after;         ///< [s]
  std::string equilibrium;                   ///< settle, nearest, or empty
  std::string inputs, outputs, independent;  ///< comma-separated; empty: all, and chosen
};
int linearise_verb(const Options& o, const LineariseOptions& l);
struct MoveOptions {
  std::string sweep, hold;       ///< comma-separated
  std::string output;            ///< a coordinate; empty: none
  std::optional<double> to, by;  ///< [rad or m]
  bool singular_values = false;
};
int move(const Options& o, const MoveOptions& m);
struct EffortOptions {
  std::filesystem::path motion;  ///< a table; empty: that of the drives
  std::string actuate, hold;     ///< comma-separated
  std::string weights;           ///< A=1,B=2
  bool poses_alone = false;      ///< at rest
  std::optional<double> within;
};
int effort(const Options& o, const EffortOptions& e);
struct FitOptions {
  std::string vary;               ///< NAME=FROM:TO, comma-separated
  std::string sweep;              ///< a coordinate; empty: a run
  std::filesystem::path to;       ///< the file of wanted poses; empty: wanted.csv beside the scene
  std::string least;              ///< a formula of the motion in place of wanted poses; empty: none
  std::vector<std::string> keep;  ///< conditions
  std::string over;               ///< FROM:TO of the swept coordinate; empty: a turn
  std::optional<int> poses;
  std::optional<double> rate;
  int starts = 1, iterations = 500;
  std::uint64_t seed = 1;
};
int fit(const Options& o, const FitOptions& f);
struct GradientOptions {
  std::string of;         ///< a formula
  std::string by;         ///< comma-separated
  bool integral = false;  ///< over the run
  std::string mode = "automatic";
};
int gradient_verb(const Options& o, const GradientOptions& g);
/// `state`: a JSON file, "-" for standard input, or text that starts with "{".
int evaluate(const Options& o, const std::string& state);
/// `forms`: comma-separated, empty: all. `state`: as for evaluate; empty: the start.
int index_verb(const Options& o, const std::string& forms, const std::string& state);
/// Whether the file that is named holds equations in place of a scene.
bool names_equations(const Options& o);
/// The verbs, of files of equations.
int run_equation_file(const Options& o);
int index_of_equations(const Options& o);
int work_on_equations(const Options& o, const WorkOptions& w);
/// Runs a suite of files of equations; `own`: references are made anew.
int bench(const Options& o, bool own);
struct ConvertOptions {
  std::filesystem::path out;      ///< empty or "-": standard output
  bool recut = false;             ///< loops cut where they are carried with the least work
  std::vector<std::string> keep;  ///< joints and loops that stay what they are
};
/// Writes the scene as TOML.
int convert(const Options& o, const ConvertOptions& c);
/// Prints a scene; `n` empty: the usual size of the family. @throws std::invalid_argument
int make(const std::string& family, std::optional<int> n, bool turned);

}  // namespace momenta::program
