// The verb `evaluate`: all values at one state.

#include <momenta/dae/report/state_report.h>
#include <momenta/dae/study/state_input.h>

#include <cstdio>

#include "answers.h"
#include "loading.h"
#include "results.h"

namespace momenta::program {

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

}  // namespace momenta::program
