// `momenta check`: a mechanism's parts, the rank of its loop equations, and how it is computed.

#include <momenta/core/open_chain/operations.h>
#include <momenta/core/scene/rod_ends.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/passed_limits.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>
#include <momenta/dae/topology/cut/integrated_scene.h>
#include <momenta/dae/topology/cut/recut.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "checked.h"
#include "loading.h"
#include "verb.h"

namespace momenta::program {
namespace {

/// Index of a form. Without rows of positions, where all are A u = b, forms with Φ = 0 have A u = b
/// in its place.
std::string index_of(const Mechanism& mechanism, const FormEntry& form) {
  if (mechanism.m() == 0) return "ODE: no loops";
  if (form.index() == 0) return "ODE";
  const bool on_rates = count_nonholonomic(mechanism) >= mechanism.m();
  return "index " + std::to_string(form.index() - (on_rates && form.lower_on_rates));
}

void print_counts(const Checked& c) {
  for (const std::string& rod : rods_that_miss_their_pins(c.mechanism.scene()))
    std::printf("  %s\n", rod.c_str());
  for (const ParameterSpec& p : c.mechanism.scene().parameters)
    std::printf("  parameter %s = %.10g%s\n", p.name.c_str(), p.value,
                p.used ? "" : ", which no formula takes");
  if (c.bodies)
    std::printf(
        "\n  %zu bodies, %d coordinates, %d rates, %d loop equations of rank %d: mobility %d\n",
        c.mechanism.scene().bodies.size(), c.mechanism.nq(), c.mechanism.nv(), c.mechanism.m(),
        c.assembly.rank, c.assembly.mobility);
  else
    std::printf("\n  %d coordinates, %d constraints of rank %d: mobility %d\n", c.mechanism.nq(),
                c.mechanism.m(), c.assembly.rank, c.assembly.mobility);
  if (const int rates_alone = count_nonholonomic(c.mechanism); rates_alone > 0)
    std::printf("  %d of the equations %s: %d positions are free, and %d rates\n", rates_alone,
                rates_alone == 1 ? "is nonholonomic" : "are nonholonomic",
                c.assembly.free_positions, c.assembly.mobility);
  if (c.mechanism.m() > 0)
    std::printf("  assembled with %s moved by at most %.3g from the guess%s%s\n",
                c.bodies ? "joints" : "coordinates", c.assembly.moved,
                c.assembly.branch.empty() ? "" : ": ", c.assembly.branch.c_str());
  const std::string rates = replaced_rates_in_words(c.mechanism, c.assembly.start);
  for (const std::string* more : {&c.assembly.residue, &rates})
    if (!more->empty()) std::printf("  %s\n", more->c_str());
}

void print_limits(const Checked& c) {
  std::vector<PassedLimit> passed;
  PassedLimits(c.mechanism).look(0, c.assembly.start.q.data(), passed);
  for (const std::string& sentence : in_words(passed)) std::printf("  %s\n", sentence.c_str());
}

void print_plan(const Checked& c) {
  std::printf("\nPlan\n");
  for (const auto& [what, how] : plan_lines(c.mechanism))
    std::printf("  %-17s %s\n", what.c_str(), how.c_str());
  if (c.bodies) {
    const Recut cuts = recut(c.mechanism, c.assembly.start);
    if (c.mechanism.m() > 0)
      std::printf("  %-17s %s%s\n", "cuts", cuts_in_words(cuts).c_str(),
                  cuts.gains() ? " (momenta convert SCENE OUT --recut)" : "");
    if (const IntegratedScene integrated(c.mechanism, c.assembly.start, &cuts); integrated.anew())
      std::printf("  %-17s %s\n", "runs integrate", integrated.in_words().c_str());
  }
}

void print_operations(const Checked& c) {
  if (c.bodies && c.mechanism.m() == 0) {
    std::printf("\nOperations of one evaluation\n");
    const auto print = [&](const char* name, Recursion recursion) {
      const OperationCount n =
          count_operations(c.tree, c.mechanism.scene(), c.mechanism.plan(), recursion);
      std::printf(
          "  %-17s %ld additions, %ld multiplications, %ld divisions, %ld sines and cosines; %ld "
          "needed once the scene's zeros and ones are folded\n",
          name, n.executed.adds, n.executed.multiplications, n.executed.divisions,
          n.executed.angles, n.needed.total());
    };
    print("momentum", Recursion::momentum);
    print("acceleration", Recursion::acceleration);
  }
}

void print_forms(const Checked& c) {
  std::printf("\nForms\n");
  for (const FormEntry& form : all_forms())
    std::printf("  %-30s %s\n", form.name.c_str(), index_of(c.mechanism, form).c_str());
}

}  // namespace

int count_nonholonomic(const Mechanism& mechanism) {
  const auto& all = mechanism.nonholonomic();
  return static_cast<int>(std::count(all.begin(), all.end(), true));
}

Checked::Checked(const Mechanism& checked)
    : mechanism(checked),
      tree(checked.tree()),
      assembly(assemble(checked)),
      bodies(!checked.scene().lagrangian),
      ranked(checked.m() > 0 && checked.m() <= most_equations),
      end(checked.scene().run.end_time) {
  if (ranked) rank = rank_report(mechanism, assembly.start);
  if (has_reach(mechanism)) reach = drive_reach(mechanism, assembly.start.t, assembly.start.q, end);
}

namespace {

int check(const Options& o) {
  const auto mechanism = load(o);
  const Checked c(*mechanism);
  if (o.json) {
    std::printf("%s\n", check_json(c).dump(2).c_str());
    return done;
  }
  if (o.quiet) return done;
  print_structure(c);
  print_counts(c);
  print_limits(c);
  if (c.ranked)
    print_rank(c.mechanism, c.rank);
  else if (c.mechanism.m() > 0)
    std::printf(
        "\nLoop equations\n  %s; singular values and poses nearby left out, of more than %d "
        "equations they take minutes\n",
        c.assembly.rank == c.mechanism.m() ? "independent by their pivots here"
                                           : "some depend on others by their pivots here",
        most_equations);
  if (has_reach(c.mechanism)) std::printf("\nDrives\n  %s\n", in_words(c.reach, c.end).c_str());
  print_plan(c);
  print_operations(c);
  print_forms(c);
  return done;
}

}  // namespace

Verb declare_check(CLI::App& app, Options& o) {
  CLI::App& verb = add_verb(app, "check", "Topology, mobility, redundant equations, the plan",
                            "momenta check examples/bricard/scene.toml");
  add_scene(verb, o);
  return {&verb, [&o] { return check(o); }};
}

}  // namespace momenta::program
