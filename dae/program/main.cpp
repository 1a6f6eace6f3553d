// The program `momenta`: one file per verb.

#include <momenta/core/kernel/levels/level.h>
#include <momenta/core/scene/scene.h>
#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/study/environment.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "help.h"
#include "options.h"
#include "values.h"

using namespace momenta::program;

namespace {

int answer(int argc, char** argv) {
  Options o;
  for (int i = 0; i < argc; ++i) o.command += (i == 0 ? "momenta" : std::string(" ") + argv[i]);
  DriftOptions d;
  WorkOptions w;
  StressOptions stress_options;
  std::string family, state = "{}";
  std::optional<int> n;
  CLI::App app(
      "Constrained multibody systems on canonical momenta: open chains, closed loops, "
      "and how far they drift.");
  app.require_subcommand(1);
  // Before the verbs: they take it over.
  app.formatter_fn(
      [](const CLI::App* of, std::string, CLI::AppFormatMode) { return screen_help(*of); });
  app.set_help_flag("--help", "This text");
  app.set_version_flag("--version", std::string("momenta ") + momenta::version(), "The version");
  app.footer(std::string(exit_status) +
             "\nExample: momenta drift examples/four_bar/scene.toml --out results");

  CLI::App* check_verb =
      app.add_subcommand("check", "Topology, mobility, redundant equations, the plan");
  check_verb->footer("Example: momenta check examples/bricard/scene.toml");
  add_scene(*check_verb, o);
  CLI::App* assemble_app =
      app.add_subcommand("assemble", "A consistent start: positions, rates, accelerations, λ");
  assemble_app->footer("Example: momenta assemble examples/andrews/scene.toml");
  add_scene(*assemble_app, o);
  AssembliesOptions assemblies_options;
  bool all_assemblies = false;
  assemble_app->add_flag("--all", all_assemblies,
                         "Every pose that is found with the coordinates of --hold where they are");
  const auto of_all = [&](CLI::Option* option) { option->needs("--all"); };
  of_all(assemble_app
             ->add_option("--hold", assemblies_options.hold,
                          "With --all: coordinates, as many as leave no freedom")
             ->type_name("NAME,..."));
  of_all(within(assemble_app->add_option("--starts", assemblies_options.starts,
                                         "With --all: starts drawn at random"),
                "N", 1, 10'000'000)
             ->capture_default_str());
  of_all(assemble_app->add_option("--seed", assemblies_options.seed, "With --all: of these")
             ->type_name("N")
             ->capture_default_str());
  of_all(within(assemble_app->add_option("--threads", assemblies_options.threads,
                                         "With --all (default: one for each processor)"),
                "N", 1, 1024));
  CLI::App* run_verb = app.add_subcommand("run", "One form, one integrator");
  run_verb->footer("Example: momenta run examples/four_bar/scene.toml --end 20 --out results");
  add_scene(*run_verb, o);
  run_verb->add_option("--form", o.form, "Which equations")
      ->capture_default_str()
      ->type_name("FORM");
  add_run_options(*run_verb, o);
  add_timing(*run_verb, o);
  one_of(run_verb->add_option("--data", o.data, "Format of the trajectory; reactions too"),
         {"csv", "hdf5"})
      ->capture_default_str();
  run_verb->add_flag("--reactions", o.reactions, "With the reactions of joints as columns");
  CLI::App* drift_verb =
      app.add_subcommand("drift", "Every form side by side: drift, energy, error against run time");
  drift_verb->footer("Example: momenta drift examples/four_bar/scene.toml --end 5 --out results");
  add_scene(*drift_verb, o);
  drift_verb->add_option("--forms", d.forms, "Default: all")->type_name("FORM,...");
  add_run_options(*drift_verb, o, "60");
  add_timing(*drift_verb, o);
  drift_verb->remove_option(drift_verb->get_option("--spectral-radius"));
  drift_verb->get_option("--integrator")->description("Of ODE forms (default: rk4, else dop853)");
  CLI::App* work_verb =
      app.add_subcommand("work", "Error against run time: every form over a series of tolerances");
  work_verb->footer("Example: momenta work examples/four_bar/scene.toml --forms momentum --end 1");
  add_scene(*work_verb, o);
  work_verb->add_option("--forms", w.forms, "Default: all")->type_name("FORM,...");
  work_verb->add_option("--integrators", w.integrators, "Each for the forms it takes")
      ->type_name("INTEGRATOR,...");
  positive(work_verb->add_option("--from", w.loosest, "Loosest tolerance"), "X")
      ->capture_default_str();
  positive(work_verb->add_option("--to", w.tightest, "Tightest tolerance"), "X")
      ->capture_default_str();
  within(work_verb->add_option("--per-decade", w.per_decade, "Tolerances in a decade"), "X", 0.25,
         100.0)
      ->capture_default_str();
  within(work_verb->add_option("--step-rungs", w.step_rungs,
                               "Number of step sizes: 2*step, step, step/2 ..."),
         "N", 1, 40)
      ->capture_default_str();
  work_verb->add_flag("--no-reference", w.no_reference,
                      "Judge by the largest drift alone; print orders");
  work_verb->add_flag("--orders", w.orders, "Print observed orders in place of the conclusion");
  add_run_options(*work_verb, o, "10");
  add_timing(*work_verb, o);
  for (const char* unused :
       {"--integrator", "--rtol", "--atol", "--spectral-radius", "--project", "--no-project",
        "--baumgarte-alpha", "--baumgarte-beta", "--beta", "--penalty"})
    work_verb->remove_option(work_verb->get_option(unused));
  CLI::App* bench_verb =
      app.add_subcommand("bench", "A suite of mechanisms or of files of equations, scored");
  bench_verb->footer("Example: momenta bench examples/suites/ivp/suite.toml --out results");
  bool own_references = false;
  bench_verb
      ->add_option("suite", o.scene, "TOML file that lists problems, forms or methods, tolerances")
      ->required()
      ->type_name("FILE");
  bench_verb->add_flag("--own-references", own_references,
                       "References are made anew, in quadruple precision");
  positive(
      bench_verb->add_option("--cpu-limit", o.cpu_limit, "CPU time of a run [s] (default: 60)"),
      "S");
  add_timing(*bench_verb, o);
  bench_verb->add_option("--out", o.out, "Directory for bench.csv, bench.json, index.html")
      ->type_name("DIR");
  bench_verb->add_flag("--json", o.json, "One JSON document on standard output");
  bench_verb->add_flag("--quiet", o.quiet, "No progress, no table");
  CLI::App* evaluate_verb =
      app.add_subcommand("evaluate", "Everything at one state, as one JSON document");
  evaluate_verb->footer(
      "Example: momenta evaluate examples/pendulum/scene.toml --at '{\"q\": {\"O\": 1.5}}'");
  add_scene(*evaluate_verb, o);
  evaluate_verb->remove_option(evaluate_verb->get_option("--at"));
  evaluate_verb
      ->add_option("--at", state,
                   "State by joint name, {\"t\": 0, \"q\": {..}, \"v\" or \"p\": {..}, \"tau\": "
                   "{..}}: a JSON file, -, or the text itself (what is left out is the start)")
      ->type_name("STATE");
  evaluate_verb->add_option("--out", o.out, "Directory for evaluate.json")->type_name("DIR");
  CLI::App* index_app = app.add_subcommand(
      "index", "The differentiation index of each form, by numbers, and its hidden constraints");
  index_app->footer("Example: momenta index examples/four_bar/scene.toml --forms momentum-index2");
  add_scene(*index_app, o);
  index_app->remove_option(index_app->get_option("--at"));
  std::string index_forms, index_state;
  index_app->add_option("--forms", index_forms, "Default: all")->type_name("FORM,...");
  index_app
      ->add_option("--at", index_state, "Consistent state, as for evaluate (default: the start)")
      ->type_name("STATE");
  add_cpu_limit(*index_app, o);
  index_app->add_option("--out", o.out, "Directory for index.json")->type_name("DIR");
  CLI::App* modes_app =
      app.add_subcommand("modes", "Equilibrium; natural frequencies, damping, mode shapes");
  modes_app->footer("Example: momenta modes examples/four_bar/scene.toml --out results");
  ModesOptions modes_options;
  add_scene(*modes_app, o);
  one_of(modes_app->add_option(
             "--equilibrium", modes_options.equilibrium,
             "Descend to a rest pose; Newton (also saddles); start pose; start motion"),
         {"settle", "nearest", "start", "steady"})
      ->capture_default_str();
  one_of(modes_app->add_option("--drives", modes_options.drives,
                               "As at t = 0, or at constant speed: a relative equilibrium"),
         {"held", "running"})
      ->capture_default_str();
  within(modes_app->add_option("--count", modes_options.count,
                               "Modes nearest to s = 0 (default: all of up to 300, else 20)"),
         "N", 1, 1000);
  add_cpu_limit(*modes_app, o);
  modes_app->add_option("--out", o.out, "Directory for modes.csv, modes.json, index.html")
      ->type_name("DIR");
  CLI::App* linearise_app =
      app.add_subcommand("linearise", "E, A, B, C, D of a linear model about a state, for control");
  linearise_app->footer("Example: momenta linearise examples/four_bar/scene.toml --out results");
  LineariseOptions linearise_options;
  add_scene(*linearise_app, o);
  for (const char* unused : {"--kkt", "--cut", "--at"})
    linearise_app->remove_option(linearise_app->get_option(unused));
  one_of(linearise_app->add_option("--kind", linearise_options.kind,
                                   "States: independent coordinates and rates; all, with λ"),
         {"minimal", "descriptor"})
      ->capture_default_str();
  linearise_app
      ->add_option("--at", linearise_options.state, "State, as for evaluate (default: the start)")
      ->type_name("STATE");
  linearise_app
      ->add_option("--time", linearise_options.time, "The start, with drives led to this time [s]")
      ->type_name("S");
  positive(linearise_app->add_option("--after", linearise_options.after,
                                     "The end of a run of this length [s]"),
           "S");
  one_of(linearise_app->add_option("--equilibrium", linearise_options.equilibrium,
                                   "At rest with drives held, found as modes finds it"),
         {"settle", "nearest"});
  linearise_app
      ->add_option("--inputs", linearise_options.inputs,
                   "By name, joint or group: efforts, drives (default: all)")
      ->type_name("NAME,...");
  linearise_app
      ->add_option("--outputs", linearise_options.outputs,
                   "Groups: coordinates, rates, accelerations, markers, efforts, multipliers")
      ->type_name("NAME,...");
  linearise_app
      ->add_option("--independent", linearise_options.independent,
                   "Coordinates that are states (default: chosen)")
      ->type_name("NAME,...");
  add_cpu_limit(*linearise_app, o, "60");
  linearise_app->add_option("--out", o.out, "Directory for linear.json, linear.m, linear.py")
      ->type_name("DIR");
  CLI::App* move_app =
      app.add_subcommand("move", "Poses, ratios, dead points as one coordinate is swept");
  move_app->footer("Example: momenta move examples/four_bar/scene.toml --sweep O --out results");
  MoveOptions move_options;
  add_scene(*move_app, o);
  for (const char* unused : {"--kkt", "--cut"})
    move_app->remove_option(move_app->get_option(unused));
  move_app
      ->add_option("--sweep", move_options.sweep,
                   "Coordinate to sweep; more of them in proportion: A=1,B=-0.5")
      ->type_name("NAME,...")
      ->required();
  move_app
      ->add_option("--hold", move_options.hold, "Coordinates that stay where they are at the start")
      ->type_name("NAME,...");
  move_app
      ->add_option("--to", move_options.to,
                   "Where the first ends [rad or m] (default: once along the curve of poses)")
      ->type_name("X");
  positive(move_app->add_option("--by", move_options.by,
                                "From pose to pose [rad or m] (default: a degree, or a hundredth "
                                "of the scene's length)"),
           "X");
  move_app
      ->add_option("--output", move_options.output,
                   "Coordinate to which force is passed: transmission angle, joint forces")
      ->type_name("NAME");
  move_app->add_flag("--singular-values", move_options.singular_values,
                     "Of the loop equations at each pose: the smallest over the largest");
  add_cpu_limit(*move_app, o);
  move_app->add_option("--out", o.out, "Directory for move.csv, move.json, index.html")
      ->type_name("DIR");
  CLI::App* effort_app =
      app.add_subcommand("effort", "Inverse dynamics: efforts of drives along a given motion");
  effort_app->footer("Example: momenta effort examples/motor/scene.toml --out results");
  EffortOptions effort_options;
  add_scene(*effort_app, o);
  for (const char* unused : {"--kkt", "--cut"})
    effort_app->remove_option(effort_app->get_option(unused));
  effort_app
      ->add_option("--motion", effort_options.motion,
                   "CSV with columns of trajectory.csv: t and coordinates; rates and accelerations "
                   "if it has them (default: the motion of the drives)")
      ->type_name("FILE");
  effort_app
      ->add_option("--actuate", effort_options.actuate,
                   "Actuated coordinates (default: the driven ones; without drives and loops all)")
      ->type_name("NAME,...");
  effort_app
      ->add_option("--weights", effort_options.weights,
                   "Of squared efforts, where actuators work against each other: A=1,B=2")
      ->type_name("NAME=W,...");
  effort_app
      ->add_option("--hold", effort_options.hold,
                   "Coordinates that stay where they are at the start")
      ->type_name("NAME,...");
  effort_app->add_flag("--static", effort_options.poses_alone,
                       "Efforts that hold each pose at rest; without a motion: the start");
  positive(effort_app->add_option("--within", effort_options.within,
                                  "How far loops may move what is given, in lengths of the scene, "
                                  "and which part of forces may be held by no actuator (default: "
                                  "1e-6)"),
           "X");
  positive(effort_app->add_option("--end", o.end, "End time of the drives' motion [s]; intervals"),
           "S");
  within(effort_app->add_option("--samples", o.samples, "Intervals of the drives' motion"), "N", 1,
         1000000);
  add_cpu_limit(*effort_app, o);
  effort_app->add_option("--out", o.out, "Directory for effort.csv, effort.json, index.html")
      ->type_name("DIR");
  CLI::App* fit_app =
      app.add_subcommand("fit", "Parameters for which a mechanism does what is wanted");
  fit_app->footer("Example: momenta fit examples/straight_line/scene.toml --vary reach --sweep O");
  FitOptions fit_options;
  add_scene(*fit_app, o);
  for (const char* unused : {"--kkt", "--cut", "--at"})
    fit_app->remove_option(fit_app->get_option(unused));
  fit_app
      ->add_option("--vary", fit_options.vary,
                   "Numbers of [parameters], each as it likes or within A=FROM:TO")
      ->type_name("NAME,...")
      ->required();
  fit_app->add_option("--sweep", fit_options.sweep, "The coordinate that moves the mechanism")
      ->type_name("NAME")
      ->required();
  fit_app
      ->add_option("--to", fit_options.to,
                   "What is wanted, a line a pose: coordinates and markers, as in move.csv, where "
                   "the swept coordinate stands if that matters (default: wanted.csv beside the "
                   "scene)")
      ->type_name("FILE");
  within(fit_app->add_option("--starts", fit_options.starts,
                             "The scene's own and others drawn from the ranges"),
         "N", 1, 100000)
      ->capture_default_str();
  fit_app->add_option("--seed", fit_options.seed, "Of these")
      ->type_name("N")
      ->capture_default_str();
  within(fit_app->add_option("--iterations", fit_options.iterations, "Of each start, at the most"),
         "N", 1, 1000000)
      ->capture_default_str();
  add_cpu_limit(*fit_app, o);
  fit_app->add_option("--out", o.out, "Directory for fitted.toml, fit.csv, fit.json, index.html")
      ->type_name("DIR");
  CLI::App* gradient_app =
      app.add_subcommand("gradient", "How a run depends on parameters and on its start");
  gradient_app->footer(
      "Example: momenta gradient examples/pendulum/scene.toml --of P.y --by O.q --end 1");
  GradientOptions gradient_options;
  add_scene(*gradient_app, o);
  for (const char* unused : {"--cut", "--at"})
    gradient_app->remove_option(gradient_app->get_option(unused));
  gradient_app
      ->add_option(
          "--of", gradient_options.of,
          "A formula of t, parameters, energy and columns of trajectory.csv: O.q, O.u, P.x")
      ->type_name("FORMULA")
      ->required();
  gradient_app->add_flag("--integral", gradient_options.integral,
                         "Its integral over the run (default: its value at the end)");
  gradient_app
      ->add_option("--by", gradient_options.by, "Numbers of [parameters]; start values: O.q, O.u")
      ->type_name("NAME,...")
      ->required();
  gradient_app->add_option("--form", o.form, "momentum, acceleration, projected or baumgarte")
      ->capture_default_str()
      ->type_name("FORM");
  add_run_options(*gradient_app, o);
  for (const char* unused :
       {"--reference", "--figures", "--penalty", "--spectral-radius", "--mesh-bytes"})
    gradient_app->remove_option(gradient_app->get_option(unused));
  gradient_app->get_option("--integrator")->description("rk4, or dp5, dop853, vern9 (by --rtol)");
  gradient_app->get_option("--out")->description("Directory for gradient.csv, gradient.json");
  CLI::App* view_verb =
      app.add_subcommand("view", "A page that shows the assembled mechanism, to turn and zoom");
  view_verb->footer(
      "Example: momenta view examples/models/agility_cassie/cassie.xml --out results");
  add_scene(*view_verb, o);
  for (const char* unused : {"--json", "--kkt", "--cut"})
    view_verb->remove_option(view_verb->get_option(unused));
  view_verb->add_option("--out", o.out, "Directory for index.html (default: standard output)")
      ->type_name("DIR");
  add_mesh_bytes(*view_verb, o);
  CLI::App* stress_app = app.add_subcommand(
      "stress", "Stress tests of a scene, or built-in ones: which form fails where");
  stress_app->footer("Example: momenta stress examples/four_bar/scene.toml --along size --end 1");
  add_scene_file(*stress_app, o, false);
  stress_app->add_option("--forms", stress_options.forms, "Default: all")->type_name("FORM,...");
  stress_app
      ->add_option("--integrators", stress_options.integrators,
                   "Each for the forms it takes (default: by form)")
      ->type_name("INTEGRATOR,...");
  stress_app
      ->add_option(
          "--along", stress_options.along,
          "Of a scene: stiffness, damping, mass ratio, size, speed, duration; built in: words of a "
          "ladder's name (default: all)")
      ->type_name("LADDER,...");
  positive(stress_app->add_option("--within", stress_options.within,
                                  "Bound on drift, energy error and error to survive"),
           "X")
      ->capture_default_str();
  positive(stress_app->add_option("--rtol", o.rtol, "Relative and absolute tolerance"), "X")
      ->capture_default_str();
  positive(stress_app->add_option("--end", o.end, "End time of the scene [s]"), "S");
  positive(
      stress_app->add_option("--cpu-limit", o.cpu_limit, "CPU time of a run [s] (default: 20)"),
      "S");
  stress_app
      ->add_option("--reference-limit", stress_options.reference_seconds,
                   "CPU time of one reference in quadruple precision [s]; 0: none")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("S")
      ->capture_default_str();
  within(stress_app->add_option("--threads", stress_options.threads,
                                "Default: one for each processor"),
         "N", 1, 1024);
  add_level(*stress_app, o);
  add_results(*stress_app, o);
  stress_app->add_flag("--json", o.json, "One JSON document on standard output");
  stress_app->add_flag("--quiet", o.quiet, "No progress, no table");
  CLI::App* sweep_app =
      app.add_subcommand("sweep", "One run for each combination of numbers of the scene");
  SweepOptions sweep_options;
  sweep_app->footer(
      "Example: momenta sweep examples/four_bar/scene.toml --vary body.crank.mass=1,2");
  add_scene(*sweep_app, o);
  sweep_app
      ->add_option("--vary", sweep_options.vary,
                   "a=1,2 or a=0:9:4[:log], sampled a=0:9, a=normal:5:1")
      ->type_name("PLACE=VALUES")
      ->required();
  one_of(sweep_app->add_option("--sample", sweep_options.sample,
                               "Points instead of combinations (256)"),
         {"random", "latin", "sobol"});
  within(sweep_app->add_option("--points", sweep_options.points, "Of a sample (default: 256)"), "N",
         std::size_t{1}, std::size_t{10'000'000});
  sweep_app->add_option("--seed", sweep_options.seed, "Of the sample (1); with Sobol indices")
      ->type_name("N");
  sweep_app->add_flag("--indices", sweep_options.indices,
                      "Sobol indices too, from points times quantities + 2 cases");
  sweep_app
      ->add_option("--watch", sweep_options.watch,
                   "Columns of the trajectory: last, least and greatest")
      ->type_name("COLUMN,...");
  sweep_app->add_option("--form", o.form, "Which equations")
      ->capture_default_str()
      ->type_name("FORM");
  add_run_options(*sweep_app, o);
  for (const char* unused : {"--reference", "--figures"})
    sweep_app->remove_option(sweep_app->get_option(unused));
  within(sweep_app->add_option("--threads", sweep_options.threads,
                               "Default: one a processor, under MPI 1; part of cases"),
         "N", 1, 1024);
  sweep_app
      ->add_option("--task", sweep_options.task,
                   "Part I of N of the cases, kept in --out; without it: joined")
      ->type_name("I/N");
  CLI::App* section_app =
      app.add_subcommand("section", "Poincaré section: where runs pass a surface");
  SectionOptions section_options;
  section_app->footer(
      "Example: momenta section examples/section/scene.toml --when x --up --end 100");
  add_scene(*section_app, o);
  section_app->add_option("--when", section_options.when, "The surface: where this formula is zero")
      ->type_name("FORMULA")
      ->required();
  auto* upwards =
      section_app->add_flag("--up", section_options.up, "From below zero to above alone");
  section_app->add_flag("--down", section_options.down, "From above zero to below alone")
      ->excludes(upwards);
  section_app
      ->add_option("--axes", section_options.axes,
                   "Two columns to be drawn (default: the last coordinate and rate)")
      ->type_name("COLUMN,COLUMN");
  section_app
      ->add_option("--starts", section_options.starts,
                   "A start value in turn: O.u=FROM:TO:COUNT or O.u=X,...")
      ->type_name("NAME=VALUES");
  section_app
      ->add_option("--energy", section_options.led,
                   "With --starts: the rate that is led so that the energy stays")
      ->type_name("NAME");
  section_app->add_option("--form", o.form, "Which equations")
      ->capture_default_str()
      ->type_name("FORM");
  add_run_options(*section_app, o);
  for (const char* unused :
       {"--reference", "--figures", "--samples", "--mesh-bytes", "--spectral-radius",
        "--baumgarte-alpha", "--baumgarte-beta", "--beta", "--penalty"})
    section_app->remove_option(section_app->get_option(unused));
  section_app->get_option("--end")->description("End time [s]");
  section_app->get_option("--out")->description("Directory for section.csv, .json, index.html");
  CLI::App* convert_verb =
      app.add_subcommand("convert", "Writes a scene, URDF or MJCF as a scene in TOML");
  convert_verb->footer("Example: momenta convert examples/models/ur5/ur5_robot.urdf ur5.toml");
  add_scene_file(*convert_verb, o);
  convert_verb->add_flag("--quiet", o.quiet, "No messages about what was skipped");
  ConvertOptions convert_options;
  convert_verb
      ->add_option("out", convert_options.out, "TOML file to write (default: standard output)")
      ->type_name("FILE");
  convert_verb->add_flag("--recut", convert_options.recut,
                         "Assemble it, and move loop cuts to where they cost less");
  convert_verb
      ->add_option("--keep", convert_options.keep,
                   "With --recut: a joint or loop to leave; repeatable")
      ->type_name("NAME");
  CLI::App* make_verb = app.add_subcommand("make", "Prints a scene of a family");
  make_verb->footer("Example: momenta make stewart --n 6 > stewart.toml");
  make_verb->add_option("family", family, "Which mechanism")->required()->type_name("FAMILY");
  make_verb->add_option("--n", n, "Size (each family has its own default)")->type_name("N");
  bool turned = false;
  make_verb->add_flag("--turned", turned, "Planar families: in a plane oblique to all axes");
  CLI::App* completion_verb =
      app.add_subcommand("completion", "Prints a script that completes this command line");
  completion_verb->footer("Example: momenta completion bash > momenta");
  std::string shell;
  one_of(completion_verb->add_option("shell", shell, "For which shell")->required(),
         {"bash", "zsh", "fish"});
  CLI::App* manual_verb = app.add_subcommand("manual", "Prints momenta(1) in roff")->group("");

  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return bad_input;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    const bool unknown = argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty();
    std::vector<std::string> verbs;
    for (const CLI::App* verb : verbs_of(app)) verbs.push_back(verb->get_name());
    if (unknown)
      std::fprintf(stderr, "momenta: verb '%.60s' is not known; expected %s\n", argv[1],
                   momenta::listed(verbs).c_str());
    else
      std::fprintf(stderr, "momenta: %s\n", e.what());
    return bad_input;
  }
  for (const CLI::App* verb : app.get_subcommands()) {
    o.asked = verb->get_name();
    for (const CLI::Option* option : verb->get_options()) {
      const std::string name = option->get_name();
      if (option->count() > 0 && name.starts_with("--")) o.given.push_back(name);
      if (option->count() == 0 || name == "scene" || name == "--reference" || name == "--out" ||
          name == "--figures" || name == "--json" || name == "--quiet" || name == "--threads" ||
          name == "--task")
        continue;
      for (const std::string& value : option->results()) o.asked += " " + name + "=" + value;
    }
  }
  try {
    if (!o.level.empty()) momenta::use_level(std::stoi(o.level));
    const bool equations = names_equations(o);
    if (equations && !*run_verb && !*index_app && !*work_verb)
      throw std::invalid_argument(o.scene.string() +
                                  " holds equations, expected a scene; run, "
                                  "index, work and, in a suite, bench take equations");
    if (*check_verb) return check(o);
    if (*assemble_app) return all_assemblies ? assemblies(o, assemblies_options) : assemble_verb(o);
    if (*run_verb) return equations ? run_equation_file(o) : run(o);
    if (*drift_verb) return drift(o, d);
    if (*work_verb) return equations ? work_on_equations(o, w) : work(o, w);
    if (*bench_verb) return bench(o, own_references);
    if (*evaluate_verb) return evaluate(o, state);
    if (*index_app)
      return equations ? index_of_equations(o) : index_verb(o, index_forms, index_state);
    if (*modes_app) return modes(o, modes_options);
    if (*linearise_app) return linearise_verb(o, linearise_options);
    if (*move_app) return move(o, move_options);
    if (*effort_app) return effort(o, effort_options);
    if (*fit_app) return fit(o, fit_options);
    if (*gradient_app) return gradient_verb(o, gradient_options);
    if (*view_verb) return view(o);
    if (*stress_app) return stress(o, stress_options);
    if (*section_app) return section(o, section_options);
    if (*sweep_app) return sweep(o, sweep_options);
    if (*convert_verb) return convert(o, convert_options);
    if (*completion_verb) return std::fputs(completion_script(app, shell).c_str(), stdout), done;
    if (*manual_verb) return std::fputs(man_page(app).c_str(), stdout), done;
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

}  // namespace

int main(int argc, char** argv) {
  // A file that may grow no further is a sentence, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const int status = answer(argc, argv);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  std::fprintf(stderr, "momenta: standard output cannot be written: %s\n", std::strerror(errno));
  return status == done ? run_failed : status;
}
