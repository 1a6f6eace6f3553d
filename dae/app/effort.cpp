// The verb `effort`: inverse dynamics along the motion of drives or of a table.

#include <momenta/dae/output/effort_report.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/study/environment.h>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct EffortOptions {
  std::filesystem::path motion;  ///< a table; empty: motion of the drives
  std::string actuate, hold;     ///< comma-separated
  std::string weights;           ///< A=1,B=2
  bool poses_alone = false;      ///< all at rest
  std::optional<double> within;
};

/// Output times of the options, else of the scene.
std::vector<double> times_of(const Options& o, const RunDefaults& defaults) {
  const double end = o.end.value_or(defaults.end_time);
  const int samples = o.samples.value_or(defaults.samples);
  std::vector<double> times;
  for (int i = 0; i <= samples; ++i) times.push_back(end * i / samples);
  return times;
}

int effort(const Options& o, const EffortOptions& options) {
  const CpuLimit limit(o.cpu_limit.value_or(0));
  const Scene driven = read(o);
  const Mechanism mechanism(undriven(driven), {.algebra = mechanism_options(o).algebra});
  expect_own_results(o.out, "effort.csv");
  EffortRequest request;
  std::optional<Reference> table;
  if (!options.motion.empty()) {
    if (!std::filesystem::is_regular_file(options.motion))
      throw std::invalid_argument("--motion " + options.motion.string() +
                                  ": cannot be read; expected a CSV with columns of "
                                  "trajectory.csv");
    table.emplace(options.motion);
    request.motion.table = &*table;
    if (o.end || o.samples)
      throw std::invalid_argument(
          "--end and --samples have no effect with --motion, expected the times of its file alone");
  }
  request.motion.drives = driven.drives;
  request.motion.hold = names_in(options.hold);
  request.motion.poses_alone = options.poses_alone;
  const bool moves = !driven.drives.empty() || table;
  if (!moves && !options.poses_alone)
    throw std::invalid_argument(o.scene.string() +
                                " has no drives, so no motion is given; expected --motion FILE, or "
                                "--static for the efforts that hold its pose");
  request.motion.times = moves ? times_of(o, driven.run) : std::vector<double>{0};
  request.actuated = names_in(options.actuate);
  request.weights = amounts_in("--weights", options.weights, "A=1,B=2");
  if (options.within) request.within = *options.within;
  const EffortResult result = momenta::effort(mechanism, request);
  const std::string text = json_text(effort_json(result));
  if (!o.out.empty()) {
    StudyResult study;
    if (const int intervals = film_intervals_of(mechanism, o, 1);
        intervals > 0 && result.rows.size() > 1) {
      study.motions.push_back(motion_of(mechanism, effort_film(result, std::min(intervals, 720))));
      study.motions.back().run = -1;
    }
    describe(study, o, mechanism, assemble(mechanism, Assembled::rates));
    if (!write_results({{o.out / "effort.csv", effort_csv(result)},
                        {o.out / "effort.json", text},
                        {o.out / "index.html", effort_page(study, result)}}))
      return run_failed;
  }
  tell(o, text, effort_table(result), "index.html");
  return done;
}

}  // namespace

Verb declare_effort(CLI::App& app, Options& o) {
  const auto own = std::make_shared<EffortOptions>();
  CLI::App& verb =
      add_verb(app, "effort", "Inverse dynamics: efforts of drives along a given motion",
               "momenta effort examples/motor/scene.toml --out results");
  add_scene(verb, o);
  without(verb, {"--kkt", "--cut"});
  verb.add_option("--motion", own->motion,
                  "CSV with columns of trajectory.csv: t and coordinates; rates and accelerations "
                  "if it has them (default: the motion of the drives)")
      ->type_name("FILE");
  verb.add_option("--actuate", own->actuate,
                  "Actuated coordinates (default: the driven ones; without drives and loops all)")
      ->type_name("NAME,...");
  verb.add_option("--weights", own->weights,
                  "Of squared efforts, where actuators work against each other: A=1,B=2")
      ->type_name("NAME=W,...");
  verb.add_option("--hold", own->hold, "Coordinates that stay where they are at the start")
      ->type_name("NAME,...");
  verb.add_flag("--static", own->poses_alone,
                "Efforts that hold each pose at rest; without a motion: the start");
  positive(verb.add_option("--within", own->within,
                           "How far loops may move what is given, in lengths of the scene, "
                           "and which part of forces may be held by no actuator (default: "
                           "1e-6)"),
           "X");
  positive(verb.add_option("--end", o.end, "End time of the drives' motion [s]; intervals"), "S");
  within(verb.add_option("--samples", o.samples, "Intervals of the drives' motion"), "N", 1,
         1000000);
  add_cpu_limit(verb, o);
  add_out(verb, o, "Directory for effort.csv, effort.json, index.html");
  return {&verb, [&o, own] { return effort(o, *own); }};
}

}  // namespace momenta::program
