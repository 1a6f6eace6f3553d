// The verb `fit`: parameters that bring a scene's mechanism to wanted poses.

#include <momenta/core/scene/file_text.h>
#include <momenta/dae/report/fit_report.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/motion.h>

#include <ctime>
#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "search.h"
#include "verb.h"

namespace momenta::program {

SweptWay way_of(const FitOptions& options) {
  SweptWay way;
  way.sweep = options.sweep;
  if (!options.over.empty())
    way.between = range_from_text("--over '" + options.over + "'", options.over, "FROM:TO");
  way.poses = options.poses.value_or(way.poses);
  way.rate = options.rate.value_or(way.rate);
  return way;
}

std::function<bool(int, double)> search_progress(const Options& o, ProgressLine& line, int starts,
                                                 const std::string& what) {
  return [&o, &line, starts, what](int start, double least) {
    line.show("start " + std::to_string(start + 1) + " of " + std::to_string(starts) +
              (start > 0 ? ", " + what + std::to_string(least) : ""));
    const double spent = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return !interrupted() && !(o.cpu_limit && spent > *o.cpu_limit);
  };
}

StudyResult shown_search(const Options& o, const FitPicture& picture, int frames,
                         const std::string& name) {
  StudyResult shown;
  if (film_intervals_of(*picture.mechanism, o, 1) >= frames && !picture.film.frames.empty()) {
    shown.motions.push_back(motion_of(*picture.mechanism, picture.film));
    shown.motions.back().run = -1;
  }
  describe(shown, o, *picture.mechanism, assemble(*picture.mechanism, Assembled::rates));
  shown.scene = name;
  return shown;
}

SceneText run_text(const Options& o) {
  SceneText scene{reading::text_of(o.scene), o.scene.string(), settings_of(o),
                  mechanism_options(o)};
  scene.options.cut = CutChoice::scene;
  return scene;
}

namespace {

int fit(const Options& o, const FitOptions& options) {
  if (!is_toml(o.scene) || !o.at.empty())
    throw std::invalid_argument(o.scene.string() +
                                ": parameters are varied in scenes of TOML alone, at their own "
                                "start; expected a .toml file without --at");
  expect_own_results(o.out, "fit.csv");
  if (!options.to.empty() && !options.least.empty())
    throw std::invalid_argument(
        "found both --to and --least; expected a file or a formula that is to be least");
  watch_signals();
  FitRequest request;
  request.sweep = options.sweep;
  request.starts = options.starts;
  request.seed = options.seed;
  request.most_iterations = options.iterations;
  std::vector<std::string> names;
  for (const std::string& text : names_in(options.vary)) {
    request.parameters.push_back(FittedParameter::from_text(text));
    names.push_back(request.parameters.back().name);
  }
  const ParametricMechanism family(reading::text_of(o.scene), o.scene.string(), settings_of(o),
                                   names, {.algebra = mechanism_options(o).algebra});
  if (!options.least.empty()) return least_verb(o, options, std::move(request.parameters), family);
  if (options.sweep.empty())
    return identify_verb(o, options, std::move(request.parameters), family);
  const std::filesystem::path file =
      options.to.empty() ? o.scene.parent_path() / "wanted.csv" : options.to;
  const WantedPoses wanted = read_wanted(file, *family.at(family.own()), options.sweep);
  request.keep = options.keep;
  request.way = way_of(options);
  ProgressLine line(o.quiet);
  request.progress = search_progress(o, line, options.starts, "least cost ");
  Options asked = o;
  asked.reference = file;  // distinguishes studies
  const auto journal = keep_runs(asked);
  request.journal = journal.get();
  const FitResult result = momenta::fit(family, wanted, request);
  line.show("");
  auto json = fit_json(result);
  json["command"] = o.command;
  json["environment"] = environment_json(environment());
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty()) {
    constexpr int frames = 240;
    const FitPicture picture = fit_picture(family, result, frames);
    const StudyResult shown = shown_search(o, picture, frames, result.scene);
    const bool written =
        write_results({{o.out / "fit.csv", fit_csv(result)},
                       {o.out / "fit.json", text},
                       {o.out / "fitted.toml", family.text(result.found)},
                       {o.out / "index.html", fit_page(shown, result, picture.first)}});
    close(journal.get(), result.starts.size(), written && !result.stopped, o);
    if (!written) return run_failed;
  }
  tell(o, text, fit_table(result), "index.html");
  return result.starts[result.best].converged && !result.stopped ? done : run_failed;
}

}  // namespace

Verb declare_fit(CLI::App& app, Options& o) {
  const auto own = std::make_shared<FitOptions>();
  CLI::App& verb = add_verb(app, "fit", "Synthesis and identification: parameters of a scene",
                            "momenta fit examples/straight_line/scene.toml --vary reach --sweep O");
  add_scene(verb, o);
  without(verb, {"--kkt", "--cut", "--at", "--loops", "--free-root", "--control", "--key"});
  verb.add_option("--vary", own->vary, "Numbers of the scene, within A=FROM:TO")
      ->type_name("NAME,...")
      ->required();
  verb.add_option("--sweep", own->sweep, "The coordinate that moves it (default: a run)")
      ->type_name("NAME");
  verb.add_option("--to", own->to,
                  "CSV: wanted, columns as in move.csv; without --sweep measured, as in "
                  "trajectory.csv (default: wanted.csv, measured.csv beside the scene)")
      ->type_name("FILE");
  verb.add_option("--least", own->least,
                  "In place of it: max, min, mean, integral, first, last of formulas of the "
                  "motion, and parameters")
      ->type_name("FORMULA");
  verb.add_option("--keep", own->keep,
                  "'a + d <= b + c', 'max(P.y) <= 2', at each pose 'C.transmission >= 0.7'; "
                  "repeatable")
      ->type_name("CONDITION")
      ->expected(1)
      ->take_all();
  verb.add_option("--over", own->over, "Way of the swept coordinate (default: a turn)")
      ->type_name("FROM:TO");
  within(verb.add_option("--poses", own->poses, "On this way (default: 73)"), "N", 2, 100000);
  verb.add_option("--rate", own->rate, "On it, for rates and efforts (default: 1)")->type_name("X");
  within(verb.add_option("--starts", own->starts, "The scene's own, others drawn"), "N", 1, 100000)
      ->capture_default_str();
  verb.add_option("--seed", own->seed, "Of these")->type_name("N")->capture_default_str();
  within(verb.add_option("--iterations", own->iterations, "Of each start, at the most"), "N", 1,
         1000000)
      ->capture_default_str();
  add_form(verb, o, "Of a run");
  add_run_options(verb, o);
  without(verb, {"--reference", "--figures", "--penalty", "--spectral-radius", "--mesh-bytes",
                 "--samples", "--baumgarte-alpha", "--baumgarte-beta", "--beta"});
  verb.get_option("--end")->description("End time [s]");
  verb.get_option("--integrator")->description("rk4, dp5, dop853, vern9 (by --rtol)");
  verb.get_option("--cpu-limit")->description("CPU time of all of it [s] (default: none)");
  verb.get_option("--out")->description("Directory for fitted.toml, fit.json, …");
  return {&verb, [&o, own] { return fit(o, *own); }};
}

}  // namespace momenta::program
