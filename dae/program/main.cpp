// The program: one verb a file.

#include <momenta/core/scene/scene.h>

#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

#include "families.h"
#include "options.h"

using namespace momenta::program;

int main(int argc, char** argv) {
  watch_signals();
  Options o;
  for (int i = 0; i < argc; ++i) o.command += (i == 0 ? "momenta" : std::string(" ") + argv[i]);
  DriftOptions d;
  WorkOptions w;
  StressOptions stress_options;
  std::string family, state = "{}";
  std::optional<int> n;
  CLI::App app(
      "Constrained multibody systems on canonical momenta: open chains, closed loops, and how far "
      "they drift.");
  app.require_subcommand(1);
  app.set_version_flag("--version", "momenta 0.1.0");
  app.footer("Example: momenta drift examples/four_bar/scene.toml --out results");

  CLI::App* check_verb =
      app.add_subcommand("check", "Topology, mobility, redundant equations, the plan");
  add_scene(*check_verb, o);
  CLI::App* assemble_app =
      app.add_subcommand("assemble", "A consistent start: positions, rates, accelerations, λ");
  add_scene(*assemble_app, o);
  CLI::App* run_verb = app.add_subcommand("run", "One form, one integrator");
  add_scene(*run_verb, o);
  run_verb->add_option("--form", o.form, "Which equations (see momenta check)")
      ->capture_default_str();
  add_run_options(*run_verb, o);
  run_verb
      ->add_option("--data", o.data,
                   "Trajectory as csv, or as hdf5: run.h5, written while the run goes on")
      ->check(CLI::IsMember({"csv", "hdf5"}))
      ->capture_default_str();
  CLI::App* drift_verb =
      app.add_subcommand("drift", "Every form side by side: drift, energy, error against run time");
  add_scene(*drift_verb, o);
  drift_verb->add_option("--forms", d.forms, "Comma-separated (default: all)");
  add_run_options(*drift_verb, o);
  CLI::App* work_verb =
      app.add_subcommand("work", "Error against run time: every form over a ladder of tolerances");
  add_scene(*work_verb, o);
  work_verb->add_option("--forms", w.forms, "Comma-separated (default: all)");
  work_verb->add_option("--integrators", w.integrators,
                        "Comma-separated, each for the forms it takes (default: dop853 and ida)");
  work_verb->add_option("--from", w.loosest, "Loosest tolerance")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  work_verb->add_option("--to", w.tightest, "Tightest tolerance")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  work_verb->add_option("--per-decade", w.per_decade, "Tolerances in a decade")
      ->check(CLI::Range(0.25, 100.0))
      ->capture_default_str();
  work_verb->add_option("--step-rungs", w.step_rungs, "Fixed steps: twice --step, and halves of it")
      ->check(CLI::Range(1, 40))
      ->capture_default_str();
  work_verb->add_flag("--no-reference", w.no_reference,
                      "Judge by the largest drift instead of a reference made in quad precision");
  add_run_options(*work_verb, o);
  for (const char* unused : {"--integrator", "--rtol", "--atol", "--project", "--no-project"})
    work_verb->remove_option(work_verb->get_option(unused));
  CLI::App* evaluate_verb =
      app.add_subcommand("evaluate", "Everything at one state, as one JSON document");
  add_scene(*evaluate_verb, o);
  evaluate_verb
      ->add_option("--at", state,
                   "State by joint name, {\"t\": 0, \"q\": {..}, \"v\" or \"p\": {..}, \"tau\": "
                   "{..}}: a JSON file, -, or the text itself (what is left out is the start)")
      ->type_name("STATE");
  evaluate_verb->add_option("--out", o.out, "Directory for evaluate.json");
  CLI::App* index_app = app.add_subcommand(
      "index", "The differentiation index of each form, by numbers, and its hidden constraints");
  add_scene(*index_app, o);
  std::string index_forms, index_state;
  index_app->add_option("--forms", index_forms, "Comma-separated (default: all)");
  index_app
      ->add_option("--at", index_state, "Consistent state, as for evaluate (default: the start)")
      ->type_name("STATE");
  index_app->add_option("--out", o.out, "Directory for index.json");
  CLI::App* modes_app = app.add_subcommand(
      "modes",
      "Where the mechanism rests, and its small motions there: frequencies, damping, shapes");
  ModesOptions modes_options;
  add_scene(*modes_app, o);
  modes_app
      ->add_option("--equilibrium", modes_options.equilibrium,
                   "settle: downhill from the assembled pose; nearest: by Newton's method, saddles "
                   "too; start: the assembled pose itself")
      ->check(CLI::IsMember({"settle", "nearest", "start"}))
      ->capture_default_str();
  modes_app
      ->add_option("--drives", modes_options.drives,
                   "held: where they are at t = 0; running: at constant speed, a relative "
                   "equilibrium")
      ->check(CLI::IsMember({"held", "running"}))
      ->capture_default_str();
  modes_app
      ->add_option("--count", modes_options.count,
                   "Modes, those nearest to s = 0 (default: all of up to 300, else 20)")
      ->check(CLI::Range(1, 1000));
  modes_app->add_option("--out", o.out, "Directory for modes.csv, modes.json, index.html");
  modes_app->footer("Example: momenta modes examples/four_bar/scene.toml --out results");
  CLI::App* view_verb =
      app.add_subcommand("view", "A page that shows the assembled mechanism, to turn and to zoom");
  add_scene(*view_verb, o);
  for (const char* unused : {"--json", "--kkt"})
    view_verb->remove_option(view_verb->get_option(unused));
  view_verb->add_option("--out", o.out, "Directory for index.html (default: standard output)");
  CLI::App* stress_app = app.add_subcommand(
      "stress", "Which form survives which extreme: of a scene, else of built-in ladders");
  add_scene_file(*stress_app, o, false);
  stress_app->add_option("--forms", stress_options.forms, "Comma-separated (default: all)");
  stress_app->add_option("--integrators", stress_options.integrators,
                         "Comma-separated, each for the forms it takes (default: by form)");
  stress_app->add_option(
      "--along", stress_options.along,
      "Of a scene: stiffness, damping, mass ratio, size, speed, duration; built in: words of a "
      "ladder's name (default: all)");
  stress_app
      ->add_option("--within", stress_options.within,
                   "Largest opening, energy error and error of what survives")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  stress_app->add_option("--rtol", o.rtol, "Relative and absolute tolerance")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  stress_app->add_option("--end", o.end, "End time of the scene [s]")->check(CLI::PositiveNumber);
  stress_app->add_option("--cpu-limit", o.cpu_limit, "Processor time of one run [s] (default: 20)")
      ->check(CLI::PositiveNumber);
  stress_app
      ->add_option("--reference-limit", stress_options.reference_seconds,
                   "Processor time of one reference in quadruple precision [s]; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  stress_app->add_option("--threads", stress_options.threads, "Default: one for each processor")
      ->check(CLI::Range(1, 1024));
  add_results(*stress_app, o);
  stress_app->add_flag("--json", o.json, "One JSON document on standard output");
  stress_app->add_flag("--quiet", o.quiet, "No progress, no table");
  CLI::App* sweep_app =
      app.add_subcommand("sweep", "One run for each combination of numbers of the scene");
  SweepOptions sweep_options;
  add_scene(*sweep_app, o);
  sweep_app
      ->add_option("--vary", sweep_options.vary,
                   "PLACE=FROM:TO:COUNT, PLACE=FROM:TO:COUNT:log or PLACE=VALUE,VALUE; a place is "
                   "body.crank.mass, joint.O.position, gravity.1, …; again for another number")
      ->required();
  sweep_app->add_option("--watch", sweep_options.watch,
                        "Columns of the trajectory, comma-separated: last, least and greatest");
  sweep_app->add_option("--form", o.form, "Which equations")->capture_default_str();
  add_run_options(*sweep_app, o);
  for (const char* unused : {"--reference", "--figures"})
    sweep_app->remove_option(sweep_app->get_option(unused));
  sweep_app
      ->add_option("--threads", sweep_options.threads,
                   "Default: one for each processor; under mpirun one in each process")
      ->check(CLI::Range(1, 1024));
  CLI::App* convert_verb =
      app.add_subcommand("convert", "Writes a scene, URDF or MJCF as a scene in TOML");
  add_scene_file(*convert_verb, o);
  convert_verb->add_flag("--quiet", o.quiet, "Do not tell what was left out");
  std::filesystem::path converted;
  convert_verb->add_option("out", converted, "TOML file to write (default: standard output)");
  CLI::App* make_verb = app.add_subcommand("make", "Prints a scene of a family");
  std::string all_families;
  for (const Family& f : families()) all_families += "\n  " + std::string(f.name) + ": " + f.what;
  make_verb->add_option("family", family, "One of:" + all_families)->required();
  make_verb->add_option("--n", n, "Size N (each family has its own default)");
  bool turned = false;
  make_verb->add_flag("--turned", turned, "Planar families: in a plane across all axes");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    const bool unknown = argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty();
    if (unknown)
      std::fprintf(stderr,
                   "momenta: verb '%.60s' is not known; expected check, assemble, evaluate, index, "
                   "modes, run, view, drift, work, stress, sweep, convert or make\n",
                   argv[1]);
    else
      std::fprintf(stderr, "momenta: %s\n", e.what());
    return bad_input;
  }
  for (const CLI::App* verb : app.get_subcommands()) {
    o.asked = verb->get_name();
    for (const CLI::Option* option : verb->get_options()) {
      const std::string name = option->get_name();
      if (option->count() == 0 || name == "scene" || name == "--reference" || name == "--out" ||
          name == "--figures" || name == "--json" || name == "--quiet" || name == "--threads")
        continue;
      for (const std::string& value : option->results()) o.asked += " " + name + "=" + value;
    }
  }
  try {
    if (*check_verb) return check(o);
    if (*assemble_app) return assemble_verb(o);
    if (*run_verb) return run(o);
    if (*drift_verb) return drift(o, d);
    if (*work_verb) return work(o, w);
    if (*evaluate_verb) return evaluate(o, state);
    if (*index_app) return index_verb(o, index_forms, index_state);
    if (*modes_app) return modes(o, modes_options);
    if (*view_verb) return view(o);
    if (*stress_app) return stress(o, stress_options);
    if (*sweep_app) return sweep(o, sweep_options);
    if (*convert_verb) return convert(o, converted);
    return make(family, n, turned);
  } catch (const momenta::SceneError& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
  } catch (const std::runtime_error& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
    return run_failed;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "momenta: not enough memory for this scene\n");
    return run_failed;
  }
  return bad_input;
}
