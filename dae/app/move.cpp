// The verb `move`: the mechanism moved through its poses by one coordinate.

#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/output/move_report.h>
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

struct MoveOptions {
  std::string sweep, hold;       ///< comma-separated
  std::string output;            ///< a coordinate; empty: none
  std::optional<double> to, by;  ///< [rad or m]
  bool singular_values = false;
};

int move(const Options& o, const MoveOptions& options) {
  const CpuLimit limit(o.cpu_limit.value_or(0));
  const Mechanism mechanism(held_at_start(read(o)), {.algebra = mechanism_options(o).algebra});
  expect_own_results(o.out, "move.csv");
  const Assembly a = assemble(mechanism, Assembled::rates);
  MoveRequest request;
  request.sweep = amounts_in("--sweep", options.sweep, "A=1,B=-0.5");
  if (request.sweep.empty())
    throw std::invalid_argument("--sweep is empty; expected the name of a coordinate");
  request.hold = names_in(options.hold);
  request.output = options.output;
  request.to = options.to;
  request.by = options.by.value_or(0);
  request.singular_values = options.singular_values;
  const MoveResult result = momenta::move(mechanism, a.start.t, a.start.q, request);
  const std::string text = json_text(move_json(result));
  if (!o.out.empty()) {
    StudyResult study;
    if (const int intervals = film_intervals_of(mechanism, o, 1); intervals > 0) {
      study.motions.push_back(motion_of(mechanism, move_film(result, std::min(intervals, 720))));
      study.motions.back().run = -1;
    }
    describe(study, o, mechanism, a);
    if (!write_results({{o.out / "move.csv", move_csv(result)},
                        {o.out / "move.json", text},
                        {o.out / "index.html", move_page(study, result)}}))
      return run_failed;
  }
  tell(o, text, move_table(result), "index.html");
  return result.end == MoveResult::End::stopped ? run_failed : done;
}

}  // namespace

Verb declare_move(CLI::App& app, Options& o) {
  const auto own = std::make_shared<MoveOptions>();
  CLI::App& verb = add_verb(app, "move", "Poses, ratios, dead points as one coordinate is swept",
                            "momenta move examples/four_bar/scene.toml --sweep O --out results");
  add_scene(verb, o);
  without(verb, {"--kkt", "--cut"});
  verb.add_option("--sweep", own->sweep,
                  "Coordinate to sweep; more of them in proportion: A=1,B=-0.5")
      ->type_name("NAME,...")
      ->required();
  verb.add_option("--hold", own->hold, "Coordinates that stay where they are at the start")
      ->type_name("NAME,...");
  verb.add_option("--to", own->to,
                  "Where the first ends [rad or m] (default: once along the curve of poses)")
      ->type_name("X");
  positive(verb.add_option("--by", own->by,
                           "From pose to pose [rad or m] (default: a degree, or a hundredth "
                           "of the scene's length)"),
           "X");
  verb.add_option("--output", own->output,
                  "Coordinate to which force is passed: transmission angle, joint forces")
      ->type_name("NAME");
  verb.add_flag("--singular-values", own->singular_values,
                "Of the loop equations at each pose: the smallest over the largest");
  add_cpu_limit(verb, o);
  add_out(verb, o, "Directory for move.csv, move.json, index.html");
  return {&verb, [&o, own] { return move(o, *own); }};
}

}  // namespace momenta::program
