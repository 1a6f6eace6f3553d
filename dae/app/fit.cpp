// The verb `fit`: parameters of a scene that bring its mechanism to wanted poses, or its run to a
// measured motion, or for which a functional of a motion is least.

#include <momenta/core/scene/file_text.h>
#include <momenta/dae/output/fit_picture.h>
#include <momenta/dae/output/fit_report.h>
#include <momenta/dae/output/identification_report.h>
#include <momenta/dae/output/least_report.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/run/motion.h>

#include <ctime>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

constexpr int frames = 240;  // of the film in a page

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

SweptWay way_of(const FitOptions& options) {
  SweptWay way;
  way.sweep = options.sweep;
  if (!options.over.empty())
    way.between = range_from_text("--over '" + options.over + "'", options.over, "FROM:TO");
  way.poses = options.poses.value_or(way.poses);
  way.rate = options.rate.value_or(way.rate);
  return way;
}

void expect_no_way(const FitOptions& options) {
  if (!options.over.empty() || options.poses || options.rate)
    throw std::invalid_argument(
        "--over, --poses and --rate are of a motion that is swept; expected --sweep NAME");
}

/// What a search of runs integrates: the scene as it is written.
template <class Request>
void take_run(const Options& o, Request& request) {
  request.scene = {reading::text_of(o.scene), o.scene.string(), settings_of(o),
                   mechanism_options(o)};
  request.scene.options.cut = CutChoice::scene;
  request.settings = run_settings(o, request.scene.scene().run);
}

/// A search from several starts: its request begun, and its result written and told.
class ParameterSearch {
 public:
  ParameterSearch(const Options& o, const FitOptions& options,
                  std::vector<FittedParameter> parameters, const ParametricMechanism& family)
      : o_(o),
        options_(options),
        parameters_(std::move(parameters)),
        family_(family),
        line_(o.quiet) {}

  /// The last of a request. `file`: what is fitted to, if anything, which distinguishes studies;
  /// `what`: the least value so far is shown as.
  template <class Request>
  void begin(Request& request, const std::filesystem::path& file, const std::string& what) {
    request.parameters = parameters_;
    request.starts = options_.starts;
    request.seed = options_.seed;
    request.most_iterations = options_.iterations;
    request.progress = [this, what](int start, double least) {
      line_.show("start " + std::to_string(start + 1) + " of " + std::to_string(options_.starts) +
                 (start > 0 ? ", " + what + std::to_string(least) : ""));
      const double spent = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
      return !interrupted() && !(o_.cpu_limit && spent > *o_.cpu_limit);
    };
    Options asked = o_;
    if (!file.empty()) asked.reference = file;
    journal_ = keep_runs(asked);
    request.journal = journal_.get();
  }

  /// The page's study: the mechanism found and the one before. `name`: of the scene.
  StudyResult shown(const FitPicture& picture, const std::string& name) const {
    StudyResult shown;
    if (film_intervals_of(*picture.mechanism, o_, 1) >= frames && !picture.film.frames.empty()) {
      shown.motions.push_back(motion_of(*picture.mechanism, picture.film));
      shown.motions.back().run = -1;
    }
    describe(shown, o_, *picture.mechanism, assemble(*picture.mechanism, Assembled::rates));
    shown.scene = name;
    return shown;
  }

  /// `drawn`: files beside fit.json and fitted.toml, made for --out alone; `looked_at`: the one to
  /// open. Returns the exit status.
  template <class Result>
  int end(const Result& result, nlohmann::ordered_json json, const std::string& table,
          const std::string& looked_at, const std::function<std::vector<ResultFile>()>& drawn) {
    line_.show("");
    const std::string text = json_text(std::move(json), o_.command);
    if (!o_.out.empty()) {
      std::vector<ResultFile> files = drawn();
      files.push_back({o_.out / "fit.json", text});
      files.push_back({o_.out / "fitted.toml", family_.text(result.found)});
      const bool written = write_results(files);
      close(journal_.get(), result.starts.size(), written && !result.stopped, o_);
      if (!written) return run_failed;
    }
    tell(o_, text, table, looked_at);
    return result.starts[result.best].converged && !result.stopped ? done : run_failed;
  }

 private:
  const Options& o_;
  const FitOptions& options_;
  std::vector<FittedParameter> parameters_;
  const ParametricMechanism& family_;
  ProgressLine line_;
  std::unique_ptr<Journal> journal_;
};

int fit_poses(const Options& o, const FitOptions& options, const ParametricMechanism& family,
              ParameterSearch& search) {
  const std::filesystem::path file =
      options.to.empty() ? o.scene.parent_path() / "wanted.csv" : options.to;
  const WantedPoses wanted = read_wanted(file, *family.at(family.own()), options.sweep);
  FitRequest request;
  request.sweep = options.sweep;
  request.keep = options.keep;
  request.way = way_of(options);
  search.begin(request, file, "least cost ");
  const FitResult result = momenta::fit(family, wanted, request);
  return search.end(result, fit_json(result), fit_table(result), "index.html", [&] {
    const FitPicture picture = fit_picture(family, result, frames);
    const StudyResult shown = search.shown(picture, result.scene);
    return std::vector<ResultFile>{{o.out / "fit.csv", fit_csv(result)},
                                   {o.out / "index.html", fit_page(shown, result, picture.first)}};
  });
}

int fit_motion(const Options& o, const FitOptions& options, const ParametricMechanism& family,
               ParameterSearch& search) {
  expect_no_way(options);
  if (!options.keep.empty())
    throw std::invalid_argument(
        "--keep does not go with a measured motion; expected ranges, as in --vary a=1:2, or "
        "--sweep or --least");
  const std::filesystem::path file =
      options.to.empty() ? o.scene.parent_path() / "measured.csv" : options.to;
  if (options.to.empty() && !std::filesystem::exists(file))
    throw std::invalid_argument(
        "expected --sweep NAME, the coordinate that moves the mechanism, --least FORMULA of a run, "
        "or --to FILE, a measured motion; there is no " +
        file.string());
  IdentificationRequest request;
  take_run(o, request);
  const MeasuredMotion measured =
      read_measured(file, Mechanism(request.scene.scene(), request.scene.options));
  search.begin(request, file, "least cost ");
  const Identification result = identify(family, measured, request);
  return search.end(
      result, identification_json(result), identification_table(result), "index.html", [&] {
        const StudyResult shown =
            search.shown(identification_picture(family, result, frames), result.scene);
        return std::vector<ResultFile>{{o.out / "fit.csv", identification_csv(result)},
                                       {o.out / "index.html", identification_page(shown, result)}};
      });
}

int fit_least(const Options& o, const FitOptions& options, const ParametricMechanism& family,
              ParameterSearch& search) {
  LeastRequest request;
  request.least = options.least;
  request.keep = options.keep;
  if (!options.sweep.empty()) {
    request.way = way_of(options);
  } else {
    expect_no_way(options);
    take_run(o, request);
  }
  search.begin(request, {}, "least so far ");
  const LeastResult result = least(family, request);
  return search.end(
      result, least_json(result), least_table(result), request.way ? "index.html" : "fit.json",
      [&] {
        std::vector<ResultFile> files;
        if (!request.way) return files;
        // The picture is that of a fit without wanted poses.
        FitResult fitted;
        fitted.own = result.own;
        fitted.found = result.found;
        fitted.swept = *result.swept;
        fitted.scene = result.scene;
        const FitPicture picture = fit_picture(family, fitted, frames);
        const StudyResult shown = search.shown(picture, result.scene);
        files.push_back({o.out / "fit.csv", least_csv(result)});
        files.push_back({o.out / "index.html", least_page(shown, result, picture.first)});
        return files;
      });
}

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
  std::vector<FittedParameter> parameters;
  std::vector<std::string> names;
  for (const std::string& text : names_in(options.vary))
    names.push_back(parameters.emplace_back(FittedParameter::from_text(text)).name);
  const ParametricMechanism family(reading::text_of(o.scene), o.scene.string(), settings_of(o),
                                   names, {.algebra = mechanism_options(o).algebra});
  ParameterSearch search(o, options, std::move(parameters), family);
  return (!options.least.empty()  ? fit_least
          : options.sweep.empty() ? fit_motion
                                  : fit_poses)(o, options, family, search);
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
