// `momenta assemble --all`: the assemblies of a mechanism with some coordinates held.

#include <momenta/dae/kinematics/assemblies.h>
#include <momenta/dae/linear/linearisation.h>
#include <momenta/dae/report/assemblies_report.h>
#include <momenta/dae/study/environment.h>

#include "answers.h"
#include "loading.h"
#include "results.h"

namespace momenta::program {

int assemblies(const Options& o, const AssembliesOptions& a) {
  const Mechanism mechanism(held_at_start(read(o)), mechanism_options(o));
  expect_own_results(o.out, "assemblies.csv");
  const Assembly own = assemble(mechanism, Assembled::rates);
  AssembliesRequest request;
  request.hold = names_in(a.hold);
  request.starts = a.starts;
  request.seed = a.seed;
  request.by_homotopy = a.by == "homotopy";
  request.threads = threads_of(a.threads);
  const Assemblies found = find_assemblies(mechanism, own.start.t, own.start.q, request);
  auto json = assemblies_json(mechanism, request, found);
  const Environment here = environment();
  if (!o.out.empty()) {
    json["command"] = o.command;
    json["environment"] = environment_json(here);
  }
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty() &&
      !write_results(
          {{o.out / "assemblies.csv", assemblies_csv(mechanism, found)},
           {o.out / "assemblies.json", text},
           {o.out / "index.html", assemblies_page(mechanism, request, found, here, o.command)}}))
    return run_failed;
  tell(o, text, assemblies_in_words(mechanism, request, found) + assemblies_table(mechanism, found),
       "index.html");
  return done;
}

}  // namespace momenta::program
