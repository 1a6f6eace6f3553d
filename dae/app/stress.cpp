#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/output/stress_report.h>
#include <momenta/dae/study/environment.h>

#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "stress_ladders.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct StressOptions {
  std::string forms, integrators, along;  ///< comma-separated; empty: the usual ones, all ladders
  double within = 1e-3;
  double reference_seconds = 10;
  int threads = 0;  ///< 0: one for each processor
};

/// Pairs that fit; a form without any of its own takes its usual method.
std::vector<Contestant> contestants_of(const std::vector<std::string>& forms,
                                       const std::vector<std::string>& methods) {
  std::vector<Contestant> all;
  for (const std::string& form : forms.empty() ? form_names() : forms) {
    const bool dae = is_dae_form(form);
    bool any = false;
    for (const std::string& name : methods) {
      const Integrator& method = integrator(name);
      if (!method.takes_form(form, dae)) continue;
      if (method.multistep && needs_one_step_method(form)) continue;
      all.push_back({form, name});
      any = true;
    }
    if (!any) all.push_back({form, ""});
  }
  return all;
}

int stress(const Options& o, const StressOptions& options) {
  expect_place_for_figures(o);
  StressRequest request;
  const auto forms = names_in(options.forms), methods = names_in(options.integrators);
  for (const auto& name : methods) integrator(name);
  request.contestants =
      forms.empty() && methods.empty() ? usual_contestants() : contestants_of(forms, methods);
  std::string title = "Built-in ladders";
  if (o.scene.empty()) {
    request.ladders = built_in_ladders();
    if (!options.along.empty())
      std::erase_if(request.ladders, [&](const Ladder& ladder) {
        const auto names = names_in(options.along);
        return std::none_of(names.begin(), names.end(), [&](const std::string& name) {
          return ladder.name.find(name) != std::string::npos;
        });
      });
    if (request.ladders.empty())
      throw std::invalid_argument("--along '" + options.along +
                                  "': no built-in ladder has that in its name, expected a word of "
                                  "one, as in a page of momenta stress");
  } else {
    Scene scene = read(o);
    if (scene.lagrangian)
      throw SceneError(scene.where(scene.lagrangian->at) +
                       "lagrangian: its masses and lengths are parameters, which stress does not "
                       "know; expected momenta sweep with --vary NAME=...");
    scene.run.end_time = o.end.value_or(scene.run.end_time);
    title = scene.name;
    request.ladders = ladders_of(scene, names_in(options.along));
  }
  request.rtol = o.rtol;
  request.bound = options.within;
  request.cpu_limit = o.cpu_limit.value_or(20);
  request.reference_cpu_limit = options.reference_seconds;
  request.threads = threads_of(options.threads);
  expect_own_results(o.out, "stress.json");
  const auto journal = keep_runs(o);
  watch_signals();
  request.journal = journal.get();
  StressResult result;
  {
    ProgressLine line(o.quiet);
    request.progress = [&](int number, int total, const std::string& what) {
      return line.going(number, total, what, static_cast<double>(number) / total);
    };
    result = run_stress_study(request);
  }
  result.command = o.command;
  const std::string json = stress_json(result).dump(2) + "\n";
  if (!o.out.empty()) {
    std::vector<ResultFile> files{{o.out / "stress.json", json},
                                  {o.out / "stress.csv", stress_csv(result)},
                                  {o.out / "index.html", stress_page(result, title)}};
    if (!o.figures.empty()) add_figures(files, figures_of_stress(result), o);
    if (!write_results(files)) return run_failed;
  }
  std::size_t runs = 0;
  for (const LadderResult& ladder : result.ladders)
    for (const auto& climb : ladder.runs) runs += climb.size();
  close(journal.get(), runs, result.complete, o);
  tell(o, json, stress_table(result));
  return result.complete ? done : run_failed;
}

}  // namespace

Verb declare_stress(CLI::App& app, Options& o) {
  const auto own = std::make_shared<StressOptions>();
  CLI::App& verb =
      add_verb(app, "stress", "Stress tests of a scene, or built-in ones: which form fails where",
               "momenta stress examples/four_bar/scene.toml --along size --end 1");
  add_scene_file(verb, o, false);
  verb.add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  verb.add_option("--integrators", own->integrators,
                  "Each for the forms it takes (default: by form)")
      ->type_name("INTEGRATOR,...");
  verb.add_option(
          "--along", own->along,
          "Of a scene: stiffness, damping, mass ratio, size, speed, duration; built in: words of a "
          "ladder's name (default: all)")
      ->type_name("LADDER,...");
  positive(
      verb.add_option("--within", own->within, "Bound on drift, energy error and error to survive"),
      "X")
      ->capture_default_str();
  positive(verb.add_option("--rtol", o.rtol, "Relative and absolute tolerance"), "X")
      ->capture_default_str();
  positive(verb.add_option("--end", o.end, "End time of the scene [s]"), "S");
  positive(verb.add_option("--cpu-limit", o.cpu_limit, "CPU time of a run [s] (default: 20)"), "S");
  within(verb.add_option("--reference-limit", own->reference_seconds,
                         "CPU time of one reference in quadruple precision [s]; 0: none"),
         "S", 0.0, 1e9)
      ->capture_default_str();
  within(verb.add_option("--threads", own->threads, "Default: one for each processor"), "N", 1,
         1024);
  add_level(verb, o);
  add_results(verb, o);
  verb.add_flag("--json", o.json, "One JSON document on standard output");
  verb.add_flag("--quiet", o.quiet, "No progress, no table");
  return {&verb, [&o, own] { return stress(o, *own); }};
}

}  // namespace momenta::program
