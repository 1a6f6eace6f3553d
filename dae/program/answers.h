#pragma once
// The function of each verb, and the options of that verb alone.

#include "options.h"

namespace momenta::program {

int check(const Options& o);
int assemble_verb(const Options& o);
struct AssembliesOptions {
  std::string hold;  ///< comma-separated
  int starts = 1000;
  std::uint64_t seed = 1;
  int threads = 0;            ///< 0: one for each processor
  std::string by = "search";  ///< search or homotopy
};
/// `assemble --all`
int assemblies(const Options& o, const AssembliesOptions& a);
int run(const Options& o);
/// The page goes to --out or standard output.
int view(const Options& o);
struct DriftOptions {
  std::string forms;  ///< comma-separated; empty: all
};
int drift(const Options& o, const DriftOptions& d);
struct WorkOptions {
  std::string forms, integrators;  ///< comma-separated; empty: all forms, dop853
  double loosest = 1e-4, tightest = 1e-12;
  double per_decade = 1;
  int step_rungs = 6;         ///< fixed steps, each half of the last
  bool no_reference = false;  ///< judge by drift alone
  bool orders = false;        ///< print observed orders in place of the conclusion
};
int work(const Options& o, const WorkOptions& w);
/// 1e-4, 1e-5, … in the given range. @throws std::invalid_argument
std::vector<double> tolerance_rungs(const WorkOptions& w);
struct StressOptions {
  std::string forms, integrators, along;  ///< comma-separated; empty: the usual ones, all ladders
  double within = 1e-3;
  double reference_seconds = 10;
  int threads = 0;  ///< 0: one for each processor
};
/// Built-in ladders without a scene.
int stress(const Options& o, const StressOptions& options);
struct SectionOptions {
  std::string when, axes, starts, led;
  bool up = false, down = false;
};
int section(const Options& o, const SectionOptions& s);

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
  std::filesystem::path motion;  ///< a table; empty: motion of the drives
  std::string actuate, hold;     ///< comma-separated
  std::string weights;           ///< A=1,B=2
  bool poses_alone = false;      ///< all at rest
  std::optional<double> within;
};
int effort(const Options& o, const EffortOptions& e);
struct FitOptions {
  std::string vary;   ///< NAME=FROM:TO, comma-separated
  std::string sweep;  ///< a coordinate; empty: a run
  /// Wanted poses, or without `sweep` a measured motion; empty: wanted.csv or measured.csv beside
  /// the scene.
  std::filesystem::path to;
  std::string least;              ///< a formula of the motion; empty: none
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
int run_equation_file(const Options& o);
int index_of_equations(const Options& o);
int work_on_equations(const Options& o, const WorkOptions& w);
/// `own`: makes references anew.
int bench(const Options& o, bool own);
struct ConvertOptions {
  std::filesystem::path out;      ///< empty or "-": standard output
  bool recut = false;             ///< cuts loops for the least work
  std::vector<std::string> keep;  ///< joints and loops that stay
};
int convert(const Options& o, const ConvertOptions& c);
/// `n` empty: the family's usual size. @throws std::invalid_argument
int make(const std::string& family, std::optional<int> n, bool turned);

}  // namespace momenta::program
