// The verb `linearise`: a linear model about a state.

#include <momenta/dae/assembly/drive_reach.h>
#include <momenta/dae/linear/equilibrium.h>
#include <momenta/dae/linear/linearisation.h>
#include <momenta/dae/report/linear_report.h>
#include <momenta/dae/study/state_after.h>
#include <momenta/dae/study/state_input.h>

#include <cmath>

#include "answers.h"
#include "cpu_limit.h"
#include "loading.h"
#include "results.h"

namespace momenta::program {
namespace {

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

}  // namespace

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

}  // namespace momenta::program
