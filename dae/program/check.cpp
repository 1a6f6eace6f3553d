#include <momenta/core/operations.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/rod_ends.h>
#include <momenta/dae/cut/integrated_scene.h>
#include <momenta/dae/cut/recut.h>
#include <momenta/dae/joint_places.h>
#include <momenta/dae/measure/rank.h>
#include <momenta/dae/study/passed_limits.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include "answers.h"
#include "cut_words.h"
#include "loading.h"
#include "reach_words.h"

namespace momenta::program {
namespace {

struct FormIndex {
  const char *form, *index;
};
constexpr FormIndex indices[] = {
    {"momentum", "ODE"},
    {"momentum-index1", "1"},
    {"momentum-index2", "2"},
    {"momentum-stabilised", "2"},
    {"momentum-index3", "3"},
    {"augmented-lagrangian-canonical", "ODE"},
    {"acceleration", "ODE"},
    {"projected", "ODE"},
    {"partitioned", "ODE"},
    {"baumgarte", "ODE"},
    {"maximal-coordinates", "ODE"},
    {"augmented-lagrangian", "ODE"},
    {"acceleration-index1", "1"},
    {"acceleration-index2", "2"},
    {"acceleration-index3", "3"},
    {"stabilised-index2", "2"},
};

/// "ground - rocker", "A, B" of a coupler; and whether drives prescribe something of it.
std::string loop_in_words(const Scene& scene, const LoopSpec& loop) {
  std::string words;
  if (has_equation(loop)) return loop.equation + " = 0";
  if (loop.kind == LoopKind::coupler) {
    for (const std::string& joint : loop.joints) words += (words.empty() ? "" : ", ") + joint;
  } else {
    words = loop.parent + " - " + loop.child;
  }
  for (const DriveSpec& drive : scene.drives)
    if (drive.loop == loop.name) return words + ", driven";
  return words;
}

int count_nonholonomic(const Mechanism& mechanism) {
  const auto& all = mechanism.nonholonomic();
  return static_cast<int>(std::count(all.begin(), all.end(), true));
}

/// Rows of positions are those that differ from form to form: without any, where all are A u = b,
/// forms that have Φ = 0 have A u = b in its place.
std::string index_of(const Mechanism& mechanism, const std::string& form, const char* index) {
  if (count_nonholonomic(mechanism) < mechanism.m()) return index;
  if (form == "momentum-index2" || form == "momentum-stabilised") return "1";
  if (form == "momentum-index3" || form == "acceleration-index3") return "2";
  return index;
}

/// Above this the singular value decompositions of the rank report take minutes.
constexpr int most_equations = 600;

/// Lines about bodies, and as many about loops, that a reader can be asked to read.
constexpr int most_lines = 200;

const std::string& loop_of(const Mechanism& mechanism, int row) {
  return mechanism.rows()[static_cast<std::size_t>(row)].loop;
}

std::string in_words(const SimplerLoop& change) {
  return change.kind.empty() ? "loop '" + change.loop + "' can be left out"
                             : "a " + change.kind + " loop in place of '" + change.loop +
                                   "' ties as much, with " + std::to_string(change.fewer) +
                                   (change.fewer == 1 ? " equation" : " equations") + " less";
}

void print_rank(const Mechanism& mechanism, const RankReport& r) {
  const int m = mechanism.m(), redundant = m - r.rank_nearby;
  std::printf(mechanism.scene().lagrangian ? "\nConstraints\n" : "\nLoop equations\n");
  if (r.rank == m) {
    std::printf("  independent: smallest singular value %.3g, of Φ_q without units\n", r.kept);
    return;
  }
  std::printf(
      "  rank %d of %d: smallest singular value that counts %.3g, largest that does not %.2g\n",
      r.rank, m, r.kept, r.dropped);
  if (r.poses == 0)
    std::printf("  nothing can move: whether this holds elsewhere cannot be told\n");
  else if (r.singular_here())
    std::printf(
        "  a singular pose: rank %d nearby. Motions in %d directions meet here; a run follows its "
        "velocities, and from rest may follow any\n",
        r.rank_nearby, mechanism.nv() - r.rank);
  for (const Dependency& d : r.dependencies)
    std::printf("  %s: %s\n", d.only_here ? "only here" : "redundant",
                in_words(mechanism, d).c_str());
  if (redundant > 0) {
    for (const SimplerLoop& change : r.simpler) std::printf("  %s\n", in_words(change).c_str());
    if (r.simpler.empty() && !mechanism.scene().lagrangian)
      std::printf(
          "  no simpler kind of loop ties as much: how the loops share the load is not "
          "determined\n");
  }
}

nlohmann::ordered_json rank_json(const Mechanism& mechanism, const RankReport& r) {
  nlohmann::ordered_json j;
  j["rank"] = r.rank;
  j["kept"] = r.kept;
  j["dropped"] = r.dropped;
  j["poses_nearby"] = r.poses;
  j["rank_nearby"] = r.rank_nearby;
  j["dependencies"] = nlohmann::json::array();
  for (const Dependency& d : r.dependencies) {
    nlohmann::ordered_json one{{"loop", loop_of(mechanism, d.row)},
                               {"row", mechanism.rows()[static_cast<std::size_t>(d.row)].what},
                               {"only_here", d.only_here},
                               {"words", in_words(mechanism, d)}};
    j["dependencies"].push_back(std::move(one));
  }
  j["simpler"] = nlohmann::json::array();
  for (const SimplerLoop& change : r.simpler)
    j["simpler"].push_back(
        {{"loop", change.loop}, {"kind", change.kind}, {"equations_fewer", change.fewer}});
  return j;
}

/// A formula over several lines in one, its spaces single.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!space) line += c;
    if (space && !line.empty() && line.back() != ' ') line += ' ';
  }
  return line;
}

/// What the author wrote.
void print_formulas(const LagrangianSpec& spec) {
  std::string names;
  for (const auto& c : spec.coordinates) names += (names.empty() ? "" : ", ") + c.name;
  std::printf("  coordinates %s\n", names.c_str());
  const auto print = [](const std::string& what, const std::string& text) {
    if (!text.empty()) std::printf("  %s = %s\n", what.c_str(), in_one_line(text).c_str());
  };
  print("L", spec.lagrangian.text);
  print("T", spec.kinetic.text);
  print("V", spec.potential.text);
  for (const auto& f : spec.forces) print("Q of " + f.coordinate, f.value.text);
  for (const auto& c : spec.constraints)
    std::printf("  constraint %s: 0 = %s\n", c.name.c_str(), in_one_line(c.equation.text).c_str());
}

nlohmann::ordered_json cut_json(const Recut& r) {
  const auto cost = [](const CutCost& c) {
    return nlohmann::ordered_json{{"open_equations", c.open},
                                  {"work", c.work},
                                  {"mass_entries", c.mass_entries},
                                  {"factor_entries", c.factor_entries},
                                  {"depth", c.depth}};
  };
  nlohmann::ordered_json j{{"now", cost(r.before)}};
  if (!r.gains()) return j;
  j["better"] = cost(r.after);
  j["better"]["cut"] = r.cut;
  j["better"]["joined"] = r.joined;
  return j;
}

}  // namespace

int check(const Options& o) {
  const auto mechanism = load(o);
  const Assembly a = assemble(*mechanism);
  const Tree& tree = mechanism->tree();
  const bool bodies = !mechanism->scene().lagrangian;
  const bool ranked = mechanism->m() > 0 && mechanism->m() <= most_equations;
  const RankReport rank = ranked ? rank_report(*mechanism, a.start) : RankReport{};
  const double end = mechanism->scene().run.end_time;
  DriveReach reach;
  if (has_reach(*mechanism)) reach = drive_reach(*mechanism, a.start.t, a.start.q, end);
  if (o.json) {
    nlohmann::ordered_json j;
    j["scene"] = tree.name;
    j["bodies"] = mechanism->scene().bodies.size();
    j["coordinates"] = mechanism->nq();
    j["rates"] = mechanism->nv();
    j["loop_equations"] = mechanism->m();
    j["rank"] = a.rank;
    j["mobility"] = a.mobility;
    j["nonholonomic_equations"] = count_nonholonomic(*mechanism);
    j["free_positions"] = a.free_positions;
    j["assembly"] = {{"moved", a.moved}, {"branch", a.branch}, {"residue", a.residue}};
    for (const auto& [what, how] : mechanism->plan_lines()) j["plan"][what] = how;
    if (bodies && mechanism->m() == 0) {
      const auto counted = [&](Recursion recursion) {
        const Operations n =
            count_operations(tree, mechanism->scene(), mechanism->plan(), recursion).executed;
        return nlohmann::ordered_json{{"additions", n.adds},
                                      {"multiplications", n.multiplications},
                                      {"divisions", n.divisions},
                                      {"sines_and_cosines", n.angles}};
      };
      j["operations"]["momentum"] = counted(Recursion::momentum);
      j["operations"]["acceleration"] = counted(Recursion::acceleration);
    }
    j["dependent_rows"] = nlohmann::json::array();
    for (int row : a.dependent_rows) {
      const auto& name = mechanism->rows()[static_cast<std::size_t>(row)];
      j["dependent_rows"].push_back({{"loop", name.loop}, {"row", name.what}});
    }
    if (ranked) j["loops"] = rank_json(*mechanism, rank);
    if (has_reach(*mechanism)) j["drives"] = reach_json(reach);
    if (bodies) {
      const Recut cuts = recut(*mechanism, a.start);
      if (mechanism->m() > 0) j["cuts"] = cut_json(cuts);
      j["integrated"] = IntegratedScene(*mechanism, a.start, &cuts).in_words();
    }
    std::printf("%s\n", j.dump(2).c_str());
    return done;
  }
  if (o.quiet) return done;
  std::printf("%s\n\n%s\n", tree.name.c_str(), bodies ? "Tree" : "Lagrangian");
  if (!bodies) print_formulas(*mechanism->scene().lagrangian);
  std::map<std::string, JointKind> kinds;
  for (const auto& joint : mechanism->scene().joints) kinds[joint.name] = joint.kind;
  const int count = static_cast<int>(tree.bodies.size());
  std::vector<int> depths(tree.bodies.size());
  int lines = 0, left_out = 0;
  for (int last = 0; last < count; ++last) {
    const auto& b = tree.bodies[static_cast<std::size_t>(last)];
    const int depth = b.parent < 0 ? 0
                                   : depths[static_cast<std::size_t>(b.parent)] +
                                         tree.carries_scene_body(b.parent);
    depths[static_cast<std::size_t>(last)] = depth;
    if (!tree.carries_scene_body(last)) continue;
    int drives = 0;
    for (int k = tree.first_part(last); k <= last; ++k)
      drives += tree.bodies[static_cast<std::size_t>(k)].drive >= 0;
    if (depth > 12 || lines == most_lines) {  // the first bodies tell the pattern
      ++left_out;
      continue;
    }
    ++lines;
    std::printf("  %*s%s (%s%s) %s, %.4g kg\n", 2 * depth, "", b.joint.c_str(),
                drives == 0         ? ""
                : drives == b.parts ? "driven "
                                    : "partly driven ",
                std::string(reading::name_of(kinds.at(b.joint))).c_str(), b.name.c_str(), b.mass);
  }
  if (left_out > 0) std::printf("  … and %d bodies more\n", left_out);
  lines = 0;
  for (const auto& loop : mechanism->scene().loops) {
    if (lines++ == most_lines) break;
    std::printf("  loop %s: %s\n", loop.name.c_str(),
                loop_in_words(mechanism->scene(), loop).c_str());
  }
  if (const auto loops = static_cast<int>(mechanism->scene().loops.size()); loops > most_lines)
    std::printf("  … and %d loops more\n", loops - most_lines);
  for (const std::string& rod : rods_that_miss_their_pins(mechanism->scene()))
    std::printf("  %s\n", rod.c_str());
  for (const ParameterSpec& p : mechanism->scene().parameters)
    std::printf("  parameter %s = %.10g%s\n", p.name.c_str(), p.value,
                p.used ? "" : ", which no formula takes");
  if (bodies)
    std::printf(
        "\n  %zu bodies, %d coordinates, %d rates, %d loop equations of rank %d: mobility %d\n",
        mechanism->scene().bodies.size(), mechanism->nq(), mechanism->nv(), mechanism->m(), a.rank,
        a.mobility);
  else
    std::printf("\n  %d coordinates, %d constraints of rank %d: mobility %d\n", mechanism->nq(),
                mechanism->m(), a.rank, a.mobility);
  if (const int rates_alone = count_nonholonomic(*mechanism); rates_alone > 0)
    std::printf("  %d of the equations %s: %d positions are free, and %d rates\n", rates_alone,
                rates_alone == 1 ? "is nonholonomic" : "are nonholonomic", a.free_positions,
                a.mobility);
  if (mechanism->m() > 0)
    std::printf("  assembled with %s moved by at most %.3g from the guess%s%s\n",
                bodies ? "joints" : "coordinates", a.moved, a.branch.empty() ? "" : ": ",
                a.branch.c_str());
  if (!a.residue.empty()) std::printf("  %s\n", a.residue.c_str());
  std::vector<PassedLimit> passed;
  PassedLimits(*mechanism).look(0, a.start.q.data(), passed);
  for (const std::string& sentence : in_words(passed)) std::printf("  %s\n", sentence.c_str());
  if (ranked)
    print_rank(*mechanism, rank);
  else if (mechanism->m() > 0)
    std::printf(
        "\nLoop equations\n  %s; singular values and poses nearby left out, of more than %d "
        "equations they take minutes\n",
        a.rank == mechanism->m() ? "independent by their pivots here"
                                 : "some depend on others by their pivots here",
        most_equations);
  if (has_reach(*mechanism)) std::printf("\nDrives\n  %s\n", in_words(reach, end).c_str());
  std::printf("\nPlan\n");
  for (const auto& [what, how] : mechanism->plan_lines())
    std::printf("  %-17s %s\n", what.c_str(), how.c_str());
  if (bodies) {
    const Recut cuts = recut(*mechanism, a.start);
    if (mechanism->m() > 0)
      std::printf("  %-17s %s%s\n", "cuts", cuts_in_words(cuts).c_str(),
                  cuts.gains() ? " (momenta convert SCENE OUT --recut)" : "");
    if (const IntegratedScene integrated(*mechanism, a.start, &cuts); integrated.anew())
      std::printf("  %-17s %s\n", "runs integrate", integrated.in_words().c_str());
  }
  if (bodies && mechanism->m() == 0) {
    std::printf("\nOperations of one evaluation\n");
    const auto print = [&](const char* name, Recursion recursion) {
      const OperationCount n =
          count_operations(tree, mechanism->scene(), mechanism->plan(), recursion);
      std::printf(
          "  %-17s %ld additions, %ld multiplications, %ld divisions, %ld sines and cosines; %ld "
          "needed once the scene's zeros and ones are folded\n",
          name, n.executed.adds, n.executed.multiplications, n.executed.divisions,
          n.executed.angles, n.needed.total());
    };
    print("momentum", Recursion::momentum);
    print("acceleration", Recursion::acceleration);
  }
  std::printf("\nForms\n");
  for (const auto& form : indices)
    std::printf(
        "  %-30s %s%s\n", form.form, mechanism->m() == 0 || form.index[0] == 'O' ? "" : "index ",
        mechanism->m() > 0 ? index_of(*mechanism, form.form, form.index).c_str() : "ODE: no loops");
  return done;
}

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
  for (const std::string* more : {&a.branch, &a.residue})
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
