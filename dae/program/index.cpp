// The index of each form, by numbers.

#include <momenta/dae/report/index_report.h>
#include <momenta/dae/text/number_text.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "options.h"
#include "state_input.h"

namespace momenta::program {
namespace {

constexpr double closed = 1e-8;  // |Φ|, |Φ̇| of a point that is given

/// The start that assembly finds, or the point asked for, if it is consistent.
Start point(const Mechanism& mechanism, const std::string& state) {
  if (state.empty()) return assemble(mechanism).start;
  const GivenState given = read_state(state, mechanism);
  const StateValues s = evaluate_state(mechanism, given);
  for (Eigen::Index i = 0; i < s.phi.size(); ++i) {
    const auto& loop = mechanism.rows()[static_cast<std::size_t>(i)].loop;
    if (!(std::abs(s.phi[i]) <= closed))
      throw SceneError("--at: loop '" + loop + "' is open by " + compact(std::abs(s.phi[i]), 3) +
                       "; expected positions that close the loops to 1e-8");
    if (!(std::abs(s.phidot[i]) <= closed * (1 + s.v.cwiseAbs().maxCoeff())))
      throw SceneError("--at: loop '" + loop + "' opens at a rate of " +
                       compact(std::abs(s.phidot[i]), 3) +
                       "; expected rates that the loops allow, as those from \"p\" are");
  }
  Start start;
  start.t = given.t;
  start.q = given.q;
  start.u = s.v;
  start.udot = mechanism.m() > 0 ? s.constrained : s.free;
  start.lambda = s.lambda;
  return start;
}

}  // namespace

int index_verb(const Options& o, const std::string& forms, const std::string& state) {
  const auto mechanism = load(o);
  std::vector<std::string> names;
  std::stringstream list(forms);
  for (std::string form; std::getline(list, form, ',');) names.push_back(form);
  const Start start = point(*mechanism, state);
  watch_signals();
  IndexStudy study;
  {
    ProgressLine line(o.quiet);
    study = run_index_study(*mechanism, start, names, [&](const std::string& form) {
      line.show(form);
      return !interrupted();
    });
  }
  const std::string json = index_json(study).dump(2) + "\n";
  if (!o.out.empty() && !write_results({{o.out / "index.json", json}})) return run_failed;
  if (o.json)
    std::fputs(json.c_str(), stdout);
  else if (!o.quiet)
    std::fputs(index_table(study).c_str(), stdout);
  if (!o.out.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "index.json").c_str());
  return interrupted() ? run_failed : done;
}

}  // namespace momenta::program
