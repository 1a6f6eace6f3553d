// The verb `fit --least`: parameters for which a functional of a motion is least.

#include <momenta/core/scene/file_text.h>
#include <momenta/dae/report/least_report.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/study/environment.h>

#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "search.h"

namespace momenta::program {

int least_verb(const Options& o, const FitOptions& options, std::vector<FittedParameter> parameters,
               const ParametricMechanism& family) {
  LeastRequest request;
  request.parameters = std::move(parameters);
  request.least = options.least;
  request.keep = options.keep;
  request.starts = options.starts;
  request.seed = options.seed;
  request.most_iterations = options.iterations;
  if (!options.sweep.empty()) {
    request.way = way_of(options);
  } else {
    if (!options.over.empty() || options.poses || options.rate)
      throw std::invalid_argument(
          "--over, --poses and --rate are of a motion that is swept; expected --sweep NAME");
    request.scene = run_text(o);
    request.settings = run_settings(o, request.scene.scene().run);
  }
  ProgressLine line(o.quiet);
  request.progress = search_progress(o, line, options.starts, "least so far ");
  const auto journal = keep_runs(o);
  request.journal = journal.get();
  const LeastResult result = least(family, request);
  line.show("");
  auto json = least_json(result);
  json["command"] = o.command;
  json["environment"] = environment_json(environment());
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty()) {
    std::vector<ResultFile> files{{o.out / "fit.json", text},
                                  {o.out / "fitted.toml", family.text(result.found)}};
    if (request.way) {
      // The picture is that of a fit without wanted poses.
      FitResult fitted;
      fitted.own = result.own;
      fitted.found = result.found;
      fitted.swept = *result.swept;
      fitted.scene = result.scene;
      constexpr int frames = 240;
      const FitPicture picture = fit_picture(family, fitted, frames);
      const StudyResult shown = shown_search(o, picture, frames, result.scene);
      files.push_back({o.out / "fit.csv", least_csv(result)});
      files.push_back({o.out / "index.html", least_page(shown, result, picture.first)});
    }
    const bool written = write_results(files);
    close(journal.get(), result.starts.size(), written && !result.stopped, o);
    if (!written) return run_failed;
  }
  tell(o, text, least_table(result), request.way ? "index.html" : "fit.json");
  return result.starts[result.best].converged && !result.stopped ? done : run_failed;
}

}  // namespace momenta::program
