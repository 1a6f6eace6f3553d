// The verb `evaluate`: all values at one state.

#include <momenta/dae/output/state_report.h>
#include <momenta/dae/run/state_input.h>

#include <cstdio>

#include "loading.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

int evaluate(const Options& o, const std::string& state) {
  const auto mechanism = load(o);
  const GivenState given = read_state(state, *mechanism);
  const StateValues values = evaluate_state(*mechanism, given);
  const std::string json = state_json(*mechanism, given, values);
  if (!o.out.empty() && !write_results({{o.out / "evaluate.json", json}})) return run_failed;
  if (o.out.empty() || o.json) std::fputs(json.c_str(), stdout);
  if (!values.not_there.empty())
    std::fprintf(stderr, "momenta: %s%s\n", mechanism->scene().where({}).c_str(),
                 values.not_there.c_str());
  if (!o.out.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "evaluate.json").c_str());
  return done;
}

}  // namespace

Verb declare_evaluate(CLI::App& app, Options& o) {
  const auto own = std::make_shared<std::string>("{}");
  CLI::App& verb =
      add_verb(app, "evaluate", "Everything at one state, as one JSON document",
               "momenta evaluate examples/pendulum/scene.toml --at '{\"q\": {\"O\": 1.5}}'");
  add_scene(verb, o);
  without(verb, {"--at"});
  verb.add_option("--at", *own,
                  "State by joint name, {\"t\": 0, \"q\": {..}, \"v\" or \"p\": {..}, \"tau\": "
                  "{..}}: a JSON file, -, or the text itself (what is left out is the start)")
      ->type_name("STATE");
  add_out(verb, o, "Directory for evaluate.json");
  return {&verb, [&o, own] { return evaluate(o, *own); }};
}

}  // namespace momenta::program
