// The verb `gradient`: the derivative of a run.

#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/dae/gradient/gradient.h>
#include <momenta/dae/output/gradient_report.h>
#include <momenta/dae/study/environment.h>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct GradientOptions {
  std::string of;         ///< a formula
  std::string by;         ///< comma-separated
  bool integral = false;  ///< over the run
  std::string mode = "automatic";
};

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
  const std::string text = json_text(gradient_json(result), o.command);
  if (!o.out.empty()) {
    std::vector<ResultFile> files{{o.out / "gradient.json", text}};
    if (request.trajectory) files.push_back({o.out / "gradient.csv", gradient_csv(result)});
    if (!write_results(files)) return run_failed;
  }
  tell(o, text, gradient_table(result), request.trajectory ? "gradient.csv" : "gradient.json");
  return done;
}

}  // namespace

Verb declare_gradient(CLI::App& app, Options& o) {
  const auto own = std::make_shared<GradientOptions>();
  CLI::App& verb =
      add_verb(app, "gradient", "How a run depends on parameters and on its start",
               "momenta gradient examples/pendulum/scene.toml --of P.y --by O.q --end 1");
  add_scene(verb, o);
  without(verb, {"--cut", "--at"});
  verb.add_option("--of", own->of,
                  "A formula of t, parameters, energy and columns of trajectory.csv: O.q, O.u, P.x")
      ->type_name("FORMULA")
      ->required();
  verb.add_flag("--integral", own->integral,
                "Its integral over the run (default: its value at the end)");
  verb.add_option("--by", own->by, "Numbers of [parameters]; start values: O.q, O.u")
      ->type_name("NAME,...")
      ->required();
  one_of(
      verb.add_option("--mode", own->mode, "A tangent for each number, or one sweep back for all"),
      {"automatic", "forward", "adjoint"})
      ->capture_default_str();
  add_form(verb, o, "momentum, acceleration, projected or baumgarte");
  add_run_options(verb, o);
  without(verb, {"--reference", "--figures", "--penalty", "--spectral-radius", "--mesh-bytes"});
  verb.get_option("--integrator")->description("rk4, or dp5, dop853, vern9 (by --rtol)");
  verb.get_option("--out")->description("Directory for gradient.csv, gradient.json");
  return {&verb, [&o, own] { return gradient_verb(o, *own); }};
}

}  // namespace momenta::program
