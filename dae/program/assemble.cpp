// `momenta assemble`: the start assembled from a scene's guess.

#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/assembly/start_accelerations.h>
#include <momenta/dae/joint_places.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answers.h"
#include "loading.h"

namespace momenta::program {

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

}  // namespace momenta::program
