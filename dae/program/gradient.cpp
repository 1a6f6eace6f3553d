// The verb `gradient`: the derivative of a run.

#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/dae/gradient/gradient.h>
#include <momenta/dae/report/gradient_report.h>
#include <momenta/dae/study/environment.h>

#include "answers.h"
#include "loading.h"
#include "progress_line.h"
#include "results.h"

namespace momenta::program {

int gradient_verb(const Options& o, const GradientOptions& options) {
  expect_own_results(o.out, "gradient.json");
  watch_signals();
  SceneText scene;
  scene.file = o.scene.string();
  scene.options = mechanism_options(o);
  scene.options.cut = CutChoice::scene;
  RunDefaults defaults;
  if (is_toml(o.scene)) {
    scene.text = reading::text_of(o.scene);
    scene.fixed = settings_of(o);
    defaults = scene.scene().run;
  } else {
    const Scene read_scene = read(o);
    scene.text = scene_text(read_scene);
    defaults = read_scene.run;
  }
  GradientRequest request;
  request.of = options.of;
  request.integral = options.integral;
  request.by = names_in(options.by);
  request.settings = run_settings(o, defaults);
  request.mode = gradient_mode(options.mode);
  request.trajectory = !o.out.empty() && request.mode != GradientMode::adjoint;
  request.max_cpu_seconds = o.cpu_limit.value_or(0);
  ProgressLine line(o.quiet);
  request.progress = [&](double t) {
    return line.going(0, 1, "gradient", t / request.settings.end_time);
  };
  const GradientResult result = gradient(scene, request);
  line.show("");
  auto json = gradient_json(result);
  json["command"] = o.command;
  json["environment"] = environment_json(environment());
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty()) {
    std::vector<ResultFile> files{{o.out / "gradient.json", text}};
    if (request.trajectory) files.push_back({o.out / "gradient.csv", gradient_csv(result)});
    if (!write_results(files)) return run_failed;
  }
  tell(o, text, gradient_table(result), request.trajectory ? "gradient.csv" : "gradient.json");
  return done;
}

}  // namespace momenta::program
