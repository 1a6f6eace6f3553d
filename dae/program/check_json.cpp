// Output of `momenta check --json`.

#include <momenta/core/operations.h>
#include <momenta/dae/assembly/replaced_rates.h>
#include <momenta/dae/cut/integrated_scene.h>
#include <momenta/dae/cut/recut.h>

#include "checked.h"
#include "reach_words.h"

namespace momenta::program {
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
  for (const auto& [what, how] : c.mechanism.plan_lines()) j["plan"][what] = how;
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
