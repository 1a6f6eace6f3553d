// The verb `fit` with a measured motion: parameters for the run nearest to it.

#include <momenta/core/scene/file_text.h>
#include <momenta/dae/report/identification_report.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/study/environment.h>

#include <filesystem>
#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "search.h"

namespace momenta::program {

int identify_verb(const Options& o, const FitOptions& options,
                  std::vector<FittedParameter> parameters, const ParametricMechanism& family) {
  if (!options.over.empty() || options.poses || options.rate)
    throw std::invalid_argument(
        "--over, --poses and --rate are of a motion that is swept; expected --sweep NAME");
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
  request.parameters = std::move(parameters);
  request.starts = options.starts;
  request.seed = options.seed;
  request.most_iterations = options.iterations;
  request.scene = run_text(o);
  request.settings = run_settings(o, request.scene.scene().run);
  const MeasuredMotion measured =
      read_measured(file, Mechanism(request.scene.scene(), request.scene.options));
  ProgressLine line(o.quiet);
  request.progress = search_progress(o, line, options.starts, "least cost ");
  Options asked = o;
  asked.reference = file;  // distinguishes studies
  const auto journal = keep_runs(asked);
  request.journal = journal.get();
  const Identification result = identify(family, measured, request);
  line.show("");
  auto json = identification_json(result);
  json["command"] = o.command;
  json["environment"] = environment_json(environment());
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty()) {
    constexpr int frames = 240;
    const FitPicture picture = identification_picture(family, result, frames);
    const StudyResult shown = shown_search(o, picture, frames, result.scene);
    const bool written =
        write_results({{o.out / "fit.csv", identification_csv(result)},
                       {o.out / "fit.json", text},
                       {o.out / "fitted.toml", family.text(result.found)},
                       {o.out / "index.html", identification_page(shown, result)}});
    close(journal.get(), result.starts.size(), written && !result.stopped, o);
    if (!written) return run_failed;
  }
  tell(o, text, identification_table(result), "index.html");
  return result.starts[result.best].converged && !result.stopped ? done : run_failed;
}

}  // namespace momenta::program
