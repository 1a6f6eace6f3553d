// The verb `modes`: an equilibrium, and the frequencies and shapes of small motions about it.

#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/output/modes_report.h>
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

struct ModesOptions {
  std::string equilibrium = "settle";  ///< settle, nearest, start or steady
  std::string drives = "held";         ///< held or running
  std::optional<int> count;
};

constexpr std::size_t most_films = 12;

/// Films as many modes as a page holds.
void film(StudyResult& study, const Mechanism& mechanism, const ModesResult& result) {
  if (mechanism.scene().lagrangian || mechanism.scene().bodies.size() > most_bodies_drawn) return;
  const auto& modes = result.spectrum.modes;
  const std::size_t count = std::min(most_films, modes.size());
  if (count == 0 || film_intervals(picture_of(mechanism), count) == 0) return;
  for (std::size_t i = 0; i < count; ++i) {
    study.motions.push_back(motion_of(mechanism, swing(mechanism, result, modes[i])));
    study.motions.back().run = static_cast<int>(i);
    study.motions.back().every = 1;
  }
}

int modes(const Options& o, const ModesOptions& m) {
  const CpuLimit limit(o.cpu_limit.value_or(0));
  Scene scene = read(o);
  // A steady motion includes all drives.
  if (m.drives == "held" && m.equilibrium != "steady") scene = held_at_start(std::move(scene));
  // --kkt is the route to the modes.
  const Mechanism mechanism(std::move(scene), {.algebra = mechanism_options(o).algebra});
  expect_own_results(o.out, "modes.csv");
  const Assembly a = assemble(mechanism);
  ModesRequest request;
  request.search = m.equilibrium == "steady"    ? Search::steady
                   : m.equilibrium == "start"   ? Search::start
                   : m.equilibrium == "nearest" ? Search::nearest
                                                : Search::settle;
  request.count = m.count.value_or(0);
  request.route = o.kkt == "dense"    ? Route::dense
                  : o.kkt == "sparse" ? Route::sparse
                                      : Route::automatic;
  const ModesResult result = find_modes(mechanism, a.start, request);
  const std::string text = json_text(modes_json(result));
  if (!o.out.empty()) {
    StudyResult study;
    film(study, mechanism, result);
    Assembly at = a;
    at.start.q = result.equilibrium.q;
    describe(study, o, mechanism, at);
    if (!write_results({{o.out / "modes.csv", modes_csv(result)},
                        {o.out / "modes.json", text},
                        {o.out / "index.html", modes_page(study, result)}}))
      return run_failed;
  }
  tell(o, text, modes_table(result), "index.html");
  return done;
}

}  // namespace

Verb declare_modes(CLI::App& app, Options& o) {
  const auto own = std::make_shared<ModesOptions>();
  CLI::App& verb = add_verb(app, "modes", "Equilibrium; natural frequencies, damping, mode shapes",
                            "momenta modes examples/four_bar/scene.toml --out results");
  add_scene(verb, o);
  one_of(verb.add_option("--equilibrium", own->equilibrium,
                         "Descend to a rest pose; Newton (also saddles); start pose; start motion"),
         {"settle", "nearest", "start", "steady"})
      ->capture_default_str();
  one_of(verb.add_option("--drives", own->drives,
                         "As at t = 0, or at constant speed: a relative equilibrium"),
         {"held", "running"})
      ->capture_default_str();
  within(verb.add_option("--count", own->count,
                         "Modes nearest to s = 0 (default: all of up to 300, else 20)"),
         "N", 1, 1000);
  add_cpu_limit(verb, o);
  add_out(verb, o, "Directory for modes.csv, modes.json, index.html");
  return {&verb, [&o, own] { return modes(o, *own); }};
}

}  // namespace momenta::program
