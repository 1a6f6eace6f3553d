// The parts of what `momenta check` finds. First bodies by their depth in the tree, or coordinates
// and formulas, and loops.

#include <momenta/core/open_chain/operations.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/number_text.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>
#include <momenta/dae/topology/cut/integrated_scene.h>
#include <momenta/dae/topology/cut/recut.h>

#include <cstdio>
#include <map>
#include <vector>
#include "checked.h"

namespace momenta::program {
namespace {

/// Lines about bodies, and about loops.
constexpr int most_lines = 200;

/// "ground - rocker", "A, B" for a coupler; and whether drives prescribe a part of it.
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

/// A formula in one line, with single spaces.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!space) line += c;
    if (space && !line.empty() && line.back() != ' ') line += ' ';
  }
  return line;
}

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

}  // namespace

void print_structure(const Checked& c) {
  std::printf("%s\n\n%s\n", c.tree.name.c_str(), c.bodies ? "Tree" : "Lagrangian");
  if (!c.bodies) print_formulas(*c.mechanism.scene().lagrangian);
  std::map<std::string, JointKind> kinds;
  for (const auto& joint : c.mechanism.scene().joints) kinds[joint.name] = joint.kind;
  const int count = static_cast<int>(c.tree.bodies.size());
  std::vector<int> depths(c.tree.bodies.size());
  int lines = 0, left_out = 0;
  for (int last = 0; last < count; ++last) {
    const auto& b = c.tree.bodies[static_cast<std::size_t>(last)];
    const int depth = b.parent < 0 ? 0
                                   : depths[static_cast<std::size_t>(b.parent)] +
                                         c.tree.carries_scene_body(b.parent);
    depths[static_cast<std::size_t>(last)] = depth;
    if (!c.tree.carries_scene_body(last)) continue;
    int drives = 0;
    for (int k = c.tree.first_part(last); k <= last; ++k)
      drives += c.tree.bodies[static_cast<std::size_t>(k)].drive >= 0;
    if (depth > 12 || lines == most_lines) {  // the first bodies show the pattern
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
  for (const auto& loop : c.mechanism.scene().loops) {
    if (lines++ == most_lines) break;
    std::printf("  loop %s: %s\n", loop.name.c_str(),
                loop_in_words(c.mechanism.scene(), loop).c_str());
  }
  if (const auto loops = static_cast<int>(c.mechanism.scene().loops.size()); loops > most_lines)
    std::printf("  … and %d loops more\n", loops - most_lines);
}

// The rank of loop equations, dependent ones, and simpler loops.

namespace {

const std::string& loop_of(const Mechanism& mechanism, int row) {
  return mechanism.rows()[static_cast<std::size_t>(row)].loop;
}

std::string in_words(const SimplerLoop& change) {
  return change.kind.empty() ? "loop '" + change.loop + "' can be left out"
                             : "a " + change.kind + " loop in place of '" + change.loop +
                                   "' ties as much, with " + std::to_string(change.fewer) +
                                   (change.fewer == 1 ? " equation" : " equations") + " less";
}

}  // namespace

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

// Reach of drives, and savings of other cuts.

bool has_reach(const Mechanism& mechanism) {
  return !mechanism.scene().drives.empty() && mechanism.m() > 0;
}

std::string in_words(const DriveReach& reach, double end) {
  if (!reach.obstacle.empty()) return reach.obstacle;
  if (!reach.determined && reach.until >= end)
    return "loops move by forces too: whether they stay closed is for a run to tell";
  std::string words = "loops close along the drives up to t = " + compact(reach.until, 6) + " s";
  if (reach.until < end) words += ", further on was not looked at";
  return words;
}

nlohmann::ordered_json reach_json(const DriveReach& reach) {
  nlohmann::ordered_json j{{"determined", reach.determined}, {"until_s", reach.until}};
  j["obstacle"] = nullptr;
  if (!reach.obstacle.empty()) j["obstacle"] = reach.obstacle;
  return j;
}

std::string cuts_in_words(const Recut& recut) {
  const CutCost &a = recut.before, &b = recut.after;
  if (!recut.gains()) return "no other cuts found that would be less work";
  char numbers[256];
  std::snprintf(numbers, sizeof numbers,
                "at most %d loop equations open at once, now %d; work on loops %.3g, now %.3g; "
                "entries of M %.3g, now %.3g; tree %d deep, now %d",
                b.open, a.open, static_cast<double>(b.work), static_cast<double>(a.work),
                static_cast<double>(b.mass_entries), static_cast<double>(a.mass_entries), b.depth,
                a.depth);
  std::string factors;
  if (b.factor_entries > 0) {
    char text[64];
    std::snprintf(text, sizeof text, "; entries of the factors %.3g, now %.3g",
                  static_cast<double>(b.factor_entries), static_cast<double>(a.factor_entries));
    factors = text;
  }
  return in_words(recut) + ": " + numbers + factors;
}

// Output of `momenta check --json`.

namespace {

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

nlohmann::ordered_json check_json(const Checked& c) {
  nlohmann::ordered_json j;
  j["scene"] = c.tree.name;
  j["bodies"] = c.mechanism.scene().bodies.size();
  j["coordinates"] = c.mechanism.nq();
  j["rates"] = c.mechanism.nv();
  j["loop_equations"] = c.mechanism.m();
  j["rank"] = c.assembly.rank;
  j["mobility"] = c.assembly.mobility;
  j["nonholonomic_equations"] = count_nonholonomic(c.mechanism);
  j["free_positions"] = c.assembly.free_positions;
  j["assembly"] = {{"moved", c.assembly.moved},
                   {"branch", c.assembly.branch},
                   {"residue", c.assembly.residue},
                   {"rates", replaced_rates_in_words(c.mechanism, c.assembly.start)}};
  for (const auto& [what, how] : plan_lines(c.mechanism)) j["plan"][what] = how;
  if (c.bodies && c.mechanism.m() == 0) {
    const auto counted = [&](Recursion recursion) {
      const Operations n =
          count_operations(c.tree, c.mechanism.scene(), c.mechanism.plan(), recursion).executed;
      return nlohmann::ordered_json{{"additions", n.adds},
                                    {"multiplications", n.multiplications},
                                    {"divisions", n.divisions},
                                    {"sines_and_cosines", n.angles}};
    };
    j["operations"]["momentum"] = counted(Recursion::momentum);
    j["operations"]["acceleration"] = counted(Recursion::acceleration);
  }
  j["dependent_rows"] = nlohmann::json::array();
  for (int row : c.assembly.dependent_rows) {
    const auto& name = c.mechanism.rows()[static_cast<std::size_t>(row)];
    j["dependent_rows"].push_back({{"loop", name.loop}, {"row", name.what}});
  }
  if (c.ranked) j["loops"] = rank_json(c.mechanism, c.rank);
  if (has_reach(c.mechanism)) j["drives"] = reach_json(c.reach);
  if (c.bodies) {
    const Recut cuts = recut(c.mechanism, c.assembly.start);
    if (c.mechanism.m() > 0) j["cuts"] = cut_json(cuts);
    j["integrated"] = IntegratedScene(c.mechanism, c.assembly.start, &cuts).in_words();
  }
  return j;
}

}  // namespace momenta::program
