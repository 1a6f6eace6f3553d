// The verb `assemble`: the start assembled from a scene's guess, or all assemblies.

#include <momenta/dae/analysis/kinematics/assemblies.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/output/assemblies_report.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "loading.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

int assemble_verb(const Options& o) {
  const auto mechanism = load(o);
  const Assembly a = assemble(*mechanism);
  nlohmann::ordered_json j;
  j["scene"] = mechanism->scene().name;
  j["position_residual"] = a.position_residual;
  j["velocity_residual"] = a.velocity_residual;
  j["moved"] = a.moved;
  j["branch"] = a.branch;
  j["residue"] = a.residue;
  const std::string rates = replaced_rates_in_words(*mechanism, a.start);
  j["rates"] = rates;
  j["iterations"] = a.iterations;
  j["mobility"] = a.mobility;
  const std::vector<JointPlace> places = joint_places(*mechanism);
  for (const JointPlace& joint : places) {
    for (const int i : joint.q) j["q"][joint.name].push_back(a.start.q[i]);
    for (const int i : joint.u) {
      j["u"][joint.name].push_back(a.start.u[i]);
      j["udot"][joint.name].push_back(a.start.udot[i]);
    }
  }
  for (int i = 0; i < mechanism->m(); ++i)
    j["lambda"][mechanism->rows()[static_cast<std::size_t>(i)].loop].push_back(a.start.lambda[i]);
  if (o.json) {
    std::printf("%s\n", j.dump(2).c_str());
    return done;
  }
  if (o.quiet) return done;
  std::printf(
      "%s: assembled in %d iterations, |Φ| %.2g, |Φ̇| %.2g, %s moved by at most %.3g from the "
      "guess\n",
      mechanism->scene().name.c_str(), a.iterations, a.position_residual, a.velocity_residual,
      mechanism->scene().lagrangian ? "coordinates" : "joints", a.moved);
  for (const std::string* more : {&a.branch, &a.residue, &rates})
    if (!more->empty()) std::printf("  %s\n", more->c_str());
  for (const JointPlace& joint : places) {
    std::printf("  %-16s", joint.name.c_str());
    for (const int i : joint.q) std::printf(" %.15g", a.start.q[i]);
    if (!joint.u.empty()) std::printf("   rate");
    for (const int i : joint.u) std::printf(" %.15g", a.start.u[i]);
    if (!joint.u.empty()) std::printf("   acceleration");
    for (const int i : joint.u) std::printf(" %.15g", a.start.udot[i]);
    std::printf("\n");
  }
  return done;
}

// assemble --all: the assemblies with some coordinates held

struct AssembliesOptions {
  std::string hold;  ///< comma-separated
  int starts = 1000;
  std::uint64_t seed = 1;
  int threads = 0;            ///< 0: one for each processor
  std::string by = "search";  ///< search or homotopy
};

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

}  // namespace

Verb declare_assemble(CLI::App& app, Options& o) {
  struct Arguments {
    AssembliesOptions assemblies;
    bool all = false;
  };
  const auto own = std::make_shared<Arguments>();
  CLI::App& verb =
      add_verb(app, "assemble", "A consistent start: positions, rates, accelerations, λ",
               "momenta assemble examples/andrews/scene.toml");
  add_scene(verb, o);
  verb.add_flag("--all", own->all,
                "Every pose that is found with the coordinates of --hold where they are");
  const auto of_all = [&](CLI::Option* option) { option->needs("--all"); };
  of_all(verb.add_option("--hold", own->assemblies.hold,
                         "With --all: coordinates, as many as leave no freedom")
             ->type_name("NAME,..."));
  of_all(within(verb.add_option("--starts", own->assemblies.starts,
                                "With --all: starts drawn at random"),
                "N", 1, 10'000'000)
             ->capture_default_str());
  of_all(verb.add_option("--seed", own->assemblies.seed, "With --all: of these")
             ->type_name("N")
             ->capture_default_str());
  of_all(within(verb.add_option("--threads", own->assemblies.threads,
                                "With --all (default: one for each processor)"),
                "N", 1, 1024));
  of_all(one_of(verb.add_option("--by", own->assemblies.by,
                                "With --all: random starts; all solutions of polynomials"),
                {"search", "homotopy"})
             ->capture_default_str());
  of_all(verb.add_option("--out", o.out,
                         "With --all: directory for assemblies.csv, assemblies.json, index.html")
             ->type_name("DIR"));
  return {&verb,
          [&o, own] { return own->all ? assemblies(o, own->assemblies) : assemble_verb(o); }};
}

}  // namespace momenta::program
