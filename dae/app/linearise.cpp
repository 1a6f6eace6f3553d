// The verb `linearise`: a linear model about a state.

#include <momenta/dae/analysis/linear/equilibrium.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/output/linear_report.h>
#include <momenta/dae/run/state_after.h>
#include <momenta/dae/run/state_input.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <cmath>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct LineariseOptions {
  std::string kind = "minimal";              ///< minimal or descriptor
  std::string state;                         ///< as for evaluate; empty: the start
  std::optional<double> time, after;         ///< [s]
  std::string equilibrium;                   ///< settle, nearest, or empty
  std::string inputs, outputs, independent;  ///< comma-separated; empty: all, and chosen
};

/// Refuses options for more than one state.
void expect_one_state(const LineariseOptions& l) {
  const int asked = (l.state.empty() ? 0 : 1) + (l.time ? 1 : 0) + (l.after ? 1 : 0) +
                    (l.equilibrium.empty() ? 0 : 1);
  if (asked > 1)
    throw std::invalid_argument(
        "--at, --time, --after and --equilibrium name a state each; expected one of them");
}

Start state_of(const Options& o, const LineariseOptions& l, const Mechanism& mechanism) {
  if (!l.state.empty()) return start_of(l.state, mechanism);
  if (l.time) {
    if (!std::isfinite(*l.time))
      throw std::invalid_argument("--time is not finite; expected a time [s]");
    return assemble_at(mechanism, *l.time).start;
  }
  if (l.after) {
    RunSettings settings = default_settings(mechanism.scene().run, "momentum", "", 1e-10);
    settings.end_time = *l.after;
    return state_after(mechanism, assemble(mechanism).start, settings, o.cpu_limit.value_or(60));
  }
  return assemble(mechanism).start;
}

LinearModel model_of(const Options& o, const LineariseOptions& l, const Mechanism& mechanism,
                     const LinearRequest& request) {
  const Start start = state_of(o, l, mechanism);
  if (l.equilibrium.empty()) return linear_model(mechanism, start, request);
  const Search search = l.equilibrium == "nearest" ? Search::nearest : Search::settle;
  return linear_model(mechanism, find_equilibrium(mechanism, start, search), request);
}

int linearise_verb(const Options& o, const LineariseOptions& l) {
  expect_one_state(l);
  const CpuLimit limit(o.cpu_limit.value_or(60));
  Scene scene = read(o);
  if (!l.equilibrium.empty()) scene = held_at_start(std::move(scene));
  const Mechanism mechanism(std::move(scene), {.algebra = mechanism_options(o).algebra});
  expect_own_results(o.out, "linear.json");
  LinearRequest request;
  request.kind =
      l.kind == "descriptor" ? LinearRequest::Kind::descriptor : LinearRequest::Kind::minimal;
  request.inputs = names_in(l.inputs);
  request.outputs = names_in(l.outputs);
  request.independent = names_in(l.independent);
  const LinearModel model = model_of(o, l, mechanism, request);
  const std::string json = linear_json(model);
  if (!o.out.empty() && !write_results({{o.out / "linear.json", json},
                                        {o.out / "linear.m", linear_octave(model)},
                                        {o.out / "linear.py", linear_python(model)}}))
    return run_failed;
  tell(o, json, linear_table(model), "linear.json");
  return done;
}

}  // namespace

Verb declare_linearise(CLI::App& app, Options& o) {
  const auto own = std::make_shared<LineariseOptions>();
  CLI::App& verb =
      add_verb(app, "linearise", "E, A, B, C, D of a linear model about a state, for control",
               "momenta linearise examples/four_bar/scene.toml --out results");
  add_scene(verb, o);
  without(verb, {"--kkt", "--cut", "--at"});
  one_of(verb.add_option("--kind", own->kind,
                         "States: independent coordinates and rates; all, with λ"),
         {"minimal", "descriptor"})
      ->capture_default_str();
  verb.add_option("--at", own->state, "State, as for evaluate (default: the start)")
      ->type_name("STATE");
  verb.add_option("--time", own->time, "The start, with drives led to this time [s]")
      ->type_name("S");
  positive(verb.add_option("--after", own->after, "The end of a run of this length [s]"), "S");
  one_of(verb.add_option("--equilibrium", own->equilibrium,
                         "At rest with drives held, found as modes finds it"),
         {"settle", "nearest"});
  verb.add_option("--inputs", own->inputs,
                  "By name, joint or group: efforts, drives (default: all)")
      ->type_name("NAME,...");
  verb.add_option("--outputs", own->outputs,
                  "Groups: coordinates, rates, accelerations, markers, efforts, multipliers")
      ->type_name("NAME,...");
  verb.add_option("--independent", own->independent,
                  "Coordinates that are states (default: chosen)")
      ->type_name("NAME,...");
  add_cpu_limit(verb, o, "60");
  add_out(verb, o, "Directory for linear.json, linear.m, linear.py");
  return {&verb, [&o, own] { return linearise_verb(o, *own); }};
}

}  // namespace momenta::program
