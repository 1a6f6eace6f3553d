// Options of verbs that analyse a mechanism, most of them without a run.

#include "verbs.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "help.h"
#include "values.h"

namespace momenta::program {

Verb add_check(CLI::App& app, Options& o) {
  CLI::App* verb = app.add_subcommand("check", "Topology, mobility, redundant equations, the plan");
  verb->footer("Example: momenta check examples/bricard/scene.toml");
  add_scene(*verb, o);
  return {verb, [&o] { return check(o); }};
}

Verb add_assemble(CLI::App& app, Options& o) {
  struct Asked {
    AssembliesOptions assemblies;
    bool all = false;
  };
  const auto own = std::make_shared<Asked>();
  CLI::App* verb =
      app.add_subcommand("assemble", "A consistent start: positions, rates, accelerations, λ");
  verb->footer("Example: momenta assemble examples/andrews/scene.toml");
  add_scene(*verb, o);
  verb->add_flag("--all", own->all,
                 "Every pose that is found with the coordinates of --hold where they are");
  const auto of_all = [&](CLI::Option* option) { option->needs("--all"); };
  of_all(verb->add_option("--hold", own->assemblies.hold,
                          "With --all: coordinates, as many as leave no freedom")
             ->type_name("NAME,..."));
  of_all(within(verb->add_option("--starts", own->assemblies.starts,
                                 "With --all: starts drawn at random"),
                "N", 1, 10'000'000)
             ->capture_default_str());
  of_all(verb->add_option("--seed", own->assemblies.seed, "With --all: of these")
             ->type_name("N")
             ->capture_default_str());
  of_all(within(verb->add_option("--threads", own->assemblies.threads,
                                 "With --all (default: one for each processor)"),
                "N", 1, 1024));
  of_all(one_of(verb->add_option("--by", own->assemblies.by,
                                 "With --all: random starts; all solutions of polynomials"),
                {"search", "homotopy"})
             ->capture_default_str());
  of_all(verb->add_option("--out", o.out,
                          "With --all: directory for assemblies.csv, assemblies.json, index.html")
             ->type_name("DIR"));
  return {verb, [&o, own] { return own->all ? assemblies(o, own->assemblies) : assemble_verb(o); }};
}

Verb add_evaluate(CLI::App& app, Options& o) {
  const auto own = std::make_shared<std::string>("{}");
  CLI::App* verb = app.add_subcommand("evaluate", "Everything at one state, as one JSON document");
  verb->footer(
      "Example: momenta evaluate examples/pendulum/scene.toml --at '{\"q\": {\"O\": 1.5}}'");
  add_scene(*verb, o);
  verb->remove_option(verb->get_option("--at"));
  verb->add_option("--at", *own,
                   "State by joint name, {\"t\": 0, \"q\": {..}, \"v\" or \"p\": {..}, \"tau\": "
                   "{..}}: a JSON file, -, or the text itself (what is left out is the start)")
      ->type_name("STATE");
  verb->add_option("--out", o.out, "Directory for evaluate.json")->type_name("DIR");
  return {verb, [&o, own] { return evaluate(o, *own); }};
}

Verb add_index(CLI::App& app, Options& o) {
  struct Wanted {
    std::string forms, state;
  };
  const auto own = std::make_shared<Wanted>();
  CLI::App* verb = app.add_subcommand(
      "index", "The differentiation index of each form, by numbers, and its hidden constraints");
  verb->footer("Example: momenta index examples/four_bar/scene.toml --forms momentum-index2");
  add_scene(*verb, o);
  verb->remove_option(verb->get_option("--at"));
  verb->add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  verb->add_option("--at", own->state, "Consistent state, as for evaluate (default: the start)")
      ->type_name("STATE");
  add_cpu_limit(*verb, o);
  verb->add_option("--out", o.out, "Directory for index.json")->type_name("DIR");
  return {verb, [&o, own] { return index_verb(o, own->forms, own->state); },
          [&o] { return index_of_equations(o); }};
}

Verb add_modes(CLI::App& app, Options& o) {
  const auto own = std::make_shared<ModesOptions>();
  CLI::App* verb =
      app.add_subcommand("modes", "Equilibrium; natural frequencies, damping, mode shapes");
  verb->footer("Example: momenta modes examples/four_bar/scene.toml --out results");
  add_scene(*verb, o);
  one_of(
      verb->add_option("--equilibrium", own->equilibrium,
                       "Descend to a rest pose; Newton (also saddles); start pose; start motion"),
      {"settle", "nearest", "start", "steady"})
      ->capture_default_str();
  one_of(verb->add_option("--drives", own->drives,
                          "As at t = 0, or at constant speed: a relative equilibrium"),
         {"held", "running"})
      ->capture_default_str();
  within(verb->add_option("--count", own->count,
                          "Modes nearest to s = 0 (default: all of up to 300, else 20)"),
         "N", 1, 1000);
  add_cpu_limit(*verb, o);
  verb->add_option("--out", o.out, "Directory for modes.csv, modes.json, index.html")
      ->type_name("DIR");
  return {verb, [&o, own] { return modes(o, *own); }};
}

Verb add_linearise(CLI::App& app, Options& o) {
  const auto own = std::make_shared<LineariseOptions>();
  CLI::App* verb =
      app.add_subcommand("linearise", "E, A, B, C, D of a linear model about a state, for control");
  verb->footer("Example: momenta linearise examples/four_bar/scene.toml --out results");
  add_scene(*verb, o);
  for (const char* unused : {"--kkt", "--cut", "--at"})
    verb->remove_option(verb->get_option(unused));
  one_of(verb->add_option("--kind", own->kind,
                          "States: independent coordinates and rates; all, with λ"),
         {"minimal", "descriptor"})
      ->capture_default_str();
  verb->add_option("--at", own->state, "State, as for evaluate (default: the start)")
      ->type_name("STATE");
  verb->add_option("--time", own->time, "The start, with drives led to this time [s]")
      ->type_name("S");
  positive(verb->add_option("--after", own->after, "The end of a run of this length [s]"), "S");
  one_of(verb->add_option("--equilibrium", own->equilibrium,
                          "At rest with drives held, found as modes finds it"),
         {"settle", "nearest"});
  verb->add_option("--inputs", own->inputs,
                   "By name, joint or group: efforts, drives (default: all)")
      ->type_name("NAME,...");
  verb->add_option("--outputs", own->outputs,
                   "Groups: coordinates, rates, accelerations, markers, efforts, multipliers")
      ->type_name("NAME,...");
  verb->add_option("--independent", own->independent,
                   "Coordinates that are states (default: chosen)")
      ->type_name("NAME,...");
  add_cpu_limit(*verb, o, "60");
  verb->add_option("--out", o.out, "Directory for linear.json, linear.m, linear.py")
      ->type_name("DIR");
  return {verb, [&o, own] { return linearise_verb(o, *own); }};
}

Verb add_move(CLI::App& app, Options& o) {
  const auto own = std::make_shared<MoveOptions>();
  CLI::App* verb =
      app.add_subcommand("move", "Poses, ratios, dead points as one coordinate is swept");
  verb->footer("Example: momenta move examples/four_bar/scene.toml --sweep O --out results");
  add_scene(*verb, o);
  for (const char* unused : {"--kkt", "--cut"}) verb->remove_option(verb->get_option(unused));
  verb->add_option("--sweep", own->sweep,
                   "Coordinate to sweep; more of them in proportion: A=1,B=-0.5")
      ->type_name("NAME,...")
      ->required();
  verb->add_option("--hold", own->hold, "Coordinates that stay where they are at the start")
      ->type_name("NAME,...");
  verb->add_option("--to", own->to,
                   "Where the first ends [rad or m] (default: once along the curve of poses)")
      ->type_name("X");
  positive(verb->add_option("--by", own->by,
                            "From pose to pose [rad or m] (default: a degree, or a hundredth "
                            "of the scene's length)"),
           "X");
  verb->add_option("--output", own->output,
                   "Coordinate to which force is passed: transmission angle, joint forces")
      ->type_name("NAME");
  verb->add_flag("--singular-values", own->singular_values,
                 "Of the loop equations at each pose: the smallest over the largest");
  add_cpu_limit(*verb, o);
  verb->add_option("--out", o.out, "Directory for move.csv, move.json, index.html")
      ->type_name("DIR");
  return {verb, [&o, own] { return move(o, *own); }};
}

Verb add_effort(CLI::App& app, Options& o) {
  const auto own = std::make_shared<EffortOptions>();
  CLI::App* verb =
      app.add_subcommand("effort", "Inverse dynamics: efforts of drives along a given motion");
  verb->footer("Example: momenta effort examples/motor/scene.toml --out results");
  add_scene(*verb, o);
  for (const char* unused : {"--kkt", "--cut"}) verb->remove_option(verb->get_option(unused));
  verb->add_option("--motion", own->motion,
                   "CSV with columns of trajectory.csv: t and coordinates; rates and accelerations "
                   "if it has them (default: the motion of the drives)")
      ->type_name("FILE");
  verb->add_option("--actuate", own->actuate,
                   "Actuated coordinates (default: the driven ones; without drives and loops all)")
      ->type_name("NAME,...");
  verb->add_option("--weights", own->weights,
                   "Of squared efforts, where actuators work against each other: A=1,B=2")
      ->type_name("NAME=W,...");
  verb->add_option("--hold", own->hold, "Coordinates that stay where they are at the start")
      ->type_name("NAME,...");
  verb->add_flag("--static", own->poses_alone,
                 "Efforts that hold each pose at rest; without a motion: the start");
  positive(verb->add_option("--within", own->within,
                            "How far loops may move what is given, in lengths of the scene, "
                            "and which part of forces may be held by no actuator (default: "
                            "1e-6)"),
           "X");
  positive(verb->add_option("--end", o.end, "End time of the drives' motion [s]; intervals"), "S");
  within(verb->add_option("--samples", o.samples, "Intervals of the drives' motion"), "N", 1,
         1000000);
  add_cpu_limit(*verb, o);
  verb->add_option("--out", o.out, "Directory for effort.csv, effort.json, index.html")
      ->type_name("DIR");
  return {verb, [&o, own] { return effort(o, *own); }};
}

Verb add_fit(CLI::App& app, Options& o) {
  const auto own = std::make_shared<FitOptions>();
  CLI::App* verb = app.add_subcommand("fit", "Synthesis and identification: parameters of a scene");
  verb->footer("Example: momenta fit examples/straight_line/scene.toml --vary reach --sweep O");
  add_scene(*verb, o);
  for (const char* unused :
       {"--kkt", "--cut", "--at", "--loops", "--free-root", "--control", "--key"})
    verb->remove_option(verb->get_option(unused));
  verb->add_option("--vary", own->vary, "Numbers of the scene, within A=FROM:TO")
      ->type_name("NAME,...")
      ->required();
  verb->add_option("--sweep", own->sweep, "The coordinate that moves it (default: a run)")
      ->type_name("NAME");
  verb->add_option("--to", own->to,
                   "CSV: wanted, columns as in move.csv; without --sweep measured, as in "
                   "trajectory.csv (default: wanted.csv, measured.csv beside the scene)")
      ->type_name("FILE");
  verb->add_option("--least", own->least,
                   "In place of it: max, min, mean, integral, first, last of formulas of the "
                   "motion, and parameters")
      ->type_name("FORMULA");
  verb->add_option("--keep", own->keep,
                   "'a + d <= b + c', 'max(P.y) <= 2', at each pose 'C.transmission >= 0.7'; "
                   "repeatable")
      ->type_name("CONDITION")
      ->expected(1)
      ->take_all();
  verb->add_option("--over", own->over, "Way of the swept coordinate (default: a turn)")
      ->type_name("FROM:TO");
  within(verb->add_option("--poses", own->poses, "On this way (default: 73)"), "N", 2, 100000);
  verb->add_option("--rate", own->rate, "On it, for rates and efforts (default: 1)")
      ->type_name("X");
  within(verb->add_option("--starts", own->starts, "The scene's own, others drawn"), "N", 1, 100000)
      ->capture_default_str();
  verb->add_option("--seed", own->seed, "Of these")->type_name("N")->capture_default_str();
  within(verb->add_option("--iterations", own->iterations, "Of each start, at the most"), "N", 1,
         1000000)
      ->capture_default_str();
  verb->add_option("--form", o.form, "Of a run")->capture_default_str()->type_name("FORM");
  add_run_options(*verb, o);
  for (const char* unused :
       {"--reference", "--figures", "--penalty", "--spectral-radius", "--mesh-bytes", "--samples",
        "--baumgarte-alpha", "--baumgarte-beta", "--beta"})
    verb->remove_option(verb->get_option(unused));
  verb->get_option("--end")->description("End time [s]");
  verb->get_option("--integrator")->description("rk4, dp5, dop853, vern9 (by --rtol)");
  verb->get_option("--cpu-limit")->description("CPU time of all of it [s] (default: none)");
  verb->get_option("--out")->description("Directory for fitted.toml, fit.json, …");
  return {verb, [&o, own] { return fit(o, *own); }};
}

Verb add_view(CLI::App& app, Options& o) {
  CLI::App* verb =
      app.add_subcommand("view", "A page that shows the assembled mechanism, to turn and zoom");
  verb->footer("Example: momenta view examples/models/agility_cassie/cassie.xml --out results");
  add_scene(*verb, o);
  for (const char* unused : {"--json", "--kkt", "--cut"})
    verb->remove_option(verb->get_option(unused));
  verb->add_option("--out", o.out, "Directory for index.html (default: standard output)")
      ->type_name("DIR");
  add_mesh_bytes(*verb, o);
  return {verb, [&o] { return view(o); }};
}

}  // namespace momenta::program
