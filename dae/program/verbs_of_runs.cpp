// Options of verbs that integrate.

#include "verbs.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "help.h"
#include "values.h"

namespace momenta::program {

Verb add_run(CLI::App& app, Options& o) {
  CLI::App* verb = app.add_subcommand("run", "One form, one integrator");
  verb->footer("Example: momenta run examples/four_bar/scene.toml --end 20 --out results");
  add_scene(*verb, o);
  verb->add_option("--form", o.form, "Which equations")->capture_default_str()->type_name("FORM");
  add_run_options(*verb, o);
  add_timing(*verb, o);
  one_of(verb->add_option("--data", o.data, "Format of the trajectory; reactions too"),
         {"csv", "hdf5"})
      ->capture_default_str();
  verb->add_flag("--reactions", o.reactions, "With the reactions of joints as columns");
  return {verb, [&o] { return run(o); }, [&o] { return run_equation_file(o); }};
}

Verb add_drift(CLI::App& app, Options& o) {
  const auto own = std::make_shared<DriftOptions>();
  CLI::App* verb =
      app.add_subcommand("drift", "Every form side by side: drift, energy, error against run time");
  verb->footer("Example: momenta drift examples/four_bar/scene.toml --end 5 --out results");
  add_scene(*verb, o);
  verb->add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  add_run_options(*verb, o, "60");
  add_timing(*verb, o);
  verb->remove_option(verb->get_option("--spectral-radius"));
  verb->get_option("--integrator")->description("Of ODE forms (default: rk4, else dop853)");
  return {verb, [&o, own] { return drift(o, *own); }};
}

Verb add_work(CLI::App& app, Options& o) {
  const auto own = std::make_shared<WorkOptions>();
  CLI::App* verb =
      app.add_subcommand("work", "Error against run time: every form over a series of tolerances");
  verb->footer("Example: momenta work examples/four_bar/scene.toml --forms momentum --end 1");
  add_scene(*verb, o);
  verb->add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  verb->add_option("--integrators", own->integrators, "Each for the forms it takes")
      ->type_name("INTEGRATOR,...");
  positive(verb->add_option("--from", own->loosest, "Loosest tolerance"), "X")
      ->capture_default_str();
  positive(verb->add_option("--to", own->tightest, "Tightest tolerance"), "X")
      ->capture_default_str();
  within(verb->add_option("--per-decade", own->per_decade, "Tolerances in a decade"), "X", 0.25,
         100.0)
      ->capture_default_str();
  within(verb->add_option("--step-rungs", own->step_rungs,
                          "Number of step sizes: 2*step, step, step/2 ..."),
         "N", 1, 40)
      ->capture_default_str();
  verb->add_flag("--no-reference", own->no_reference,
                 "Judge by the largest drift alone; print orders");
  verb->add_flag("--orders", own->orders, "Print observed orders in place of the conclusion");
  add_run_options(*verb, o, "10");
  add_timing(*verb, o);
  for (const char* unused :
       {"--integrator", "--rtol", "--atol", "--spectral-radius", "--project", "--no-project",
        "--baumgarte-alpha", "--baumgarte-beta", "--beta", "--penalty"})
    verb->remove_option(verb->get_option(unused));
  return {verb, [&o, own] { return work(o, *own); },
          [&o, own] { return work_on_equations(o, *own); }};
}

Verb add_bench(CLI::App& app, Options& o) {
  const auto own = std::make_shared<bool>(false);
  CLI::App* verb =
      app.add_subcommand("bench", "A suite of mechanisms or of files of equations, scored");
  verb->footer("Example: momenta bench examples/suites/ivp/suite.toml --out results");
  verb->add_option("suite", o.scene, "TOML file that lists problems, forms or methods, tolerances")
      ->required()
      ->type_name("FILE");
  verb->add_flag("--own-references", *own, "References are made anew, in quadruple precision");
  positive(verb->add_option("--cpu-limit", o.cpu_limit, "CPU time of a run [s] (default: 60)"),
           "S");
  add_timing(*verb, o);
  verb->add_option("--out", o.out, "Directory for bench.csv, bench.json, index.html")
      ->type_name("DIR");
  verb->add_flag("--json", o.json, "One JSON document on standard output");
  verb->add_flag("--quiet", o.quiet, "No progress, no table");
  return {verb, [&o, own] { return bench(o, *own); }};
}

Verb add_gradient(CLI::App& app, Options& o) {
  const auto own = std::make_shared<GradientOptions>();
  CLI::App* verb =
      app.add_subcommand("gradient", "How a run depends on parameters and on its start");
  verb->footer("Example: momenta gradient examples/pendulum/scene.toml --of P.y --by O.q --end 1");
  add_scene(*verb, o);
  for (const char* unused : {"--cut", "--at"}) verb->remove_option(verb->get_option(unused));
  verb->add_option(
          "--of", own->of,
          "A formula of t, parameters, energy and columns of trajectory.csv: O.q, O.u, P.x")
      ->type_name("FORMULA")
      ->required();
  verb->add_flag("--integral", own->integral,
                 "Its integral over the run (default: its value at the end)");
  verb->add_option("--by", own->by, "Numbers of [parameters]; start values: O.q, O.u")
      ->type_name("NAME,...")
      ->required();
  one_of(
      verb->add_option("--mode", own->mode, "A tangent for each number, or one sweep back for all"),
      {"automatic", "forward", "adjoint"})
      ->capture_default_str();
  verb->add_option("--form", o.form, "momentum, acceleration, projected or baumgarte")
      ->capture_default_str()
      ->type_name("FORM");
  add_run_options(*verb, o);
  for (const char* unused :
       {"--reference", "--figures", "--penalty", "--spectral-radius", "--mesh-bytes"})
    verb->remove_option(verb->get_option(unused));
  verb->get_option("--integrator")->description("rk4, or dp5, dop853, vern9 (by --rtol)");
  verb->get_option("--out")->description("Directory for gradient.csv, gradient.json");
  return {verb, [&o, own] { return gradient_verb(o, *own); }};
}

Verb add_stress(CLI::App& app, Options& o) {
  const auto own = std::make_shared<StressOptions>();
  CLI::App* verb = app.add_subcommand(
      "stress", "Stress tests of a scene, or built-in ones: which form fails where");
  verb->footer("Example: momenta stress examples/four_bar/scene.toml --along size --end 1");
  add_scene_file(*verb, o, false);
  verb->add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  verb->add_option("--integrators", own->integrators,
                   "Each for the forms it takes (default: by form)")
      ->type_name("INTEGRATOR,...");
  verb->add_option(
          "--along", own->along,
          "Of a scene: stiffness, damping, mass ratio, size, speed, duration; built in: words of a "
          "ladder's name (default: all)")
      ->type_name("LADDER,...");
  positive(verb->add_option("--within", own->within,
                            "Bound on drift, energy error and error to survive"),
           "X")
      ->capture_default_str();
  positive(verb->add_option("--rtol", o.rtol, "Relative and absolute tolerance"), "X")
      ->capture_default_str();
  positive(verb->add_option("--end", o.end, "End time of the scene [s]"), "S");
  positive(verb->add_option("--cpu-limit", o.cpu_limit, "CPU time of a run [s] (default: 20)"),
           "S");
  within(verb->add_option("--reference-limit", own->reference_seconds,
                          "CPU time of one reference in quadruple precision [s]; 0: none"),
         "S", 0.0, 1e9)
      ->capture_default_str();
  within(verb->add_option("--threads", own->threads, "Default: one for each processor"), "N", 1,
         1024);
  add_level(*verb, o);
  add_results(*verb, o);
  verb->add_flag("--json", o.json, "One JSON document on standard output");
  verb->add_flag("--quiet", o.quiet, "No progress, no table");
  return {verb, [&o, own] { return stress(o, *own); }};
}

Verb add_sweep(CLI::App& app, Options& o) {
  const auto own = std::make_shared<SweepOptions>();
  CLI::App* verb =
      app.add_subcommand("sweep", "One run for each combination of numbers of the scene");
  verb->footer("Example: momenta sweep examples/four_bar/scene.toml --vary body.crank.mass=1,2");
  add_scene(*verb, o);
  verb->add_option("--vary", own->vary, "a=1,2 or a=0:9:4[:log], sampled a=0:9, a=normal:5:1")
      ->type_name("PLACE=VALUES")
      ->required();
  one_of(verb->add_option("--sample", own->sample, "Points instead of combinations (256)"),
         {"random", "latin", "sobol"});
  within(verb->add_option("--points", own->points, "Of a sample (default: 256)"), "N",
         std::size_t{1}, std::size_t{10'000'000});
  verb->add_option("--seed", own->seed, "Of the sample (1); with Sobol indices")->type_name("N");
  verb->add_flag("--indices", own->indices,
                 "Sobol indices too, from points times quantities + 2 cases");
  verb->add_option("--watch", own->watch, "Columns of the trajectory: last, least and greatest")
      ->type_name("COLUMN,...");
  verb->add_option("--form", o.form, "Which equations")->capture_default_str()->type_name("FORM");
  add_run_options(*verb, o);
  for (const char* unused : {"--reference", "--figures"})
    verb->remove_option(verb->get_option(unused));
  within(verb->add_option("--threads", own->threads,
                          "Default: one a processor, under MPI 1; part of cases"),
         "N", 1, 1024);
  verb->add_option("--task", own->task,
                   "Part I of N of the cases, kept in --out; without it: joined")
      ->type_name("I/N");
  return {verb, [&o, own] { return sweep(o, *own); }};
}

Verb add_section(CLI::App& app, Options& o) {
  const auto own = std::make_shared<SectionOptions>();
  CLI::App* verb = app.add_subcommand("section", "Poincaré section: where runs pass a surface");
  verb->footer("Example: momenta section examples/section/scene.toml --when x --up --end 100");
  add_scene(*verb, o);
  verb->add_option("--when", own->when, "The surface: where this formula is zero")
      ->type_name("FORMULA")
      ->required();
  auto* upwards = verb->add_flag("--up", own->up, "From below zero to above alone");
  verb->add_flag("--down", own->down, "From above zero to below alone")->excludes(upwards);
  verb->add_option("--axes", own->axes,
                   "Two columns to be drawn (default: the last coordinate and rate)")
      ->type_name("COLUMN,COLUMN");
  verb->add_option("--starts", own->starts, "A start value in turn: O.u=FROM:TO:COUNT or O.u=X,...")
      ->type_name("NAME=VALUES");
  verb->add_option("--energy", own->led,
                   "With --starts: the rate that is led so that the energy stays")
      ->type_name("NAME");
  verb->add_option("--form", o.form, "Which equations")->capture_default_str()->type_name("FORM");
  add_run_options(*verb, o);
  for (const char* unused :
       {"--reference", "--figures", "--samples", "--mesh-bytes", "--spectral-radius",
        "--baumgarte-alpha", "--baumgarte-beta", "--beta", "--penalty"})
    verb->remove_option(verb->get_option(unused));
  verb->get_option("--end")->description("End time [s]");
  verb->get_option("--out")->description("Directory for section.csv, .json, index.html");
  return {verb, [&o, own] { return section(o, *own); }};
}

}  // namespace momenta::program
