// The verb `fit`: parameters of a scene for which its mechanism does what is wanted.

#include <momenta/core/scene/file_text.h>
#include <momenta/dae/report/fit_picture.h>
#include <momenta/dae/report/fit_report.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/motion.h>

#include <ctime>
#include <stdexcept>

#include "options.h"

namespace momenta::program {

int fit(const Options& o, const FitOptions& options) {
  if (!is_toml(o.scene) || !o.at.empty())
    throw std::invalid_argument(o.scene.string() +
                                ": parameters are varied in scenes of TOML alone, at their own "
                                "start; expected a .toml file without --at");
  expect_own_results(o.out, "fit.csv");
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
  const WantedPoses wanted =
      read_wanted(options.to.empty() ? o.scene.parent_path() / "wanted.csv" : options.to,
                  *family.at(family.own()), options.sweep);
  ProgressLine line(o.quiet);
  request.progress = [&](int start, double least) {
    line.show("start " + std::to_string(start + 1) + " of " + std::to_string(options.starts) +
              (start > 0 ? ", least cost " + std::to_string(least) : ""));
    const double spent = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return !interrupted() && !(o.cpu_limit && spent > *o.cpu_limit);
  };
  const FitResult result = momenta::fit(family, wanted, request);
  line.show("");
  auto json = fit_json(result);
  json["command"] = o.command;
  json["environment"] = environment_json(environment());
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty()) {
    constexpr int frames = 240;
    const FitPicture picture = fit_picture(family, result, frames);
    StudyResult study;
    if (film_intervals_of(*picture.mechanism, o, 1) >= frames) {
      study.motions.push_back(motion_of(*picture.mechanism, picture.film));
      study.motions.back().run = -1;
    }
    describe(study, o, *picture.mechanism, assemble(*picture.mechanism, Assembled::rates));
    study.scene = result.scene;
    if (!write_results({{o.out / "fit.csv", fit_csv(result)},
                        {o.out / "fit.json", text},
                        {o.out / "fitted.toml", family.text(result.found)},
                        {o.out / "index.html", fit_page(study, result, picture.first)}}))
      return run_failed;
  }
  tell(o, text, fit_table(result), "index.html");
  return result.starts[result.best].converged && !result.stopped ? done : run_failed;
}

}  // namespace momenta::program
