// Lines of a mechanism's plan: what evaluations compute, and how (7) is solved.

#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/link.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/mechanism/model_data.h>

namespace momenta {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

/// Work saved at spherical joints of a tree without loops: bodies that carry nothing are eliminated
/// once; where there are no others nothing is swept.
std::string tops_in_words(const LinkTree& tree) {
  std::size_t ends = 0, tops = 0;
  for (const Link& l : tree.links) {
    ends += l.kind == LinkKind::spherical && l.leaf;
    tops += l.kind == LinkKind::spherical && l.leaf && l.parent < 0;
  }
  if (ends == 0) return "";
  return tops == tree.links.size()
             ? "; their bodies carry nothing: ω = I⁻¹ p with I constant, no sweeps"
             : "; spherical joints of bodies that carry nothing, eliminated once: " +
                   std::to_string(ends);
}

Lines lagrangian_lines(const Mechanism& mechanism) {
  const LagrangianModel& model = mechanism.lagrangian();
  Lines lines;
  const auto count = [](const Expression& f) { return std::to_string(f.tape().size()); };
  lines.emplace_back("equations",
                     "formulas of a Lagrangian, with exact derivatives: " + count(model.momenta) +
                         " instructions for p, " + count(model.momentum_rates) + " for ṗ");
  lines.emplace_back("mass matrix", std::to_string(model.mass.places.size()) + " entries of " +
                                        std::to_string(model.n * (model.n + 1) / 2) +
                                        (model.linear ? "; L has terms linear in the rates" : ""));
  lines.emplace_back("time", model.in_time ? "in the formulas" : "in no formula");
  lines.emplace_back("forces", mechanism.scene().lagrangian->forces.empty()
                                   ? "none beside the Lagrangian's"
                                   : std::to_string(mechanism.scene().lagrangian->forces.size()));
  return lines;
}

void add_links(const LinkTree& links, bool loops, Lines& lines) {
  lines.emplace_back("joints", links_in_words(links) + (loops ? "" : tops_in_words(links)));
  if (loops) return;
  const std::string branches = branches_in_words(links, branch_lanes_at(best_level()));
  lines.emplace_back("branches", branches.empty() ? "none of one shape: body by body" : branches);
}

}  // namespace

Lines plan_lines(const Mechanism& mechanism) {
  const Scene& scene = mechanism.scene();
  const int m = mechanism.m();
  const std::string loops = scene.lagrangian ? "constraints" : "loops";
  Lines lines = scene.lagrangian ? lagrangian_lines(mechanism) : mechanism.plan().lines();
  mechanism.visit([&]<class Space>(const ModelData<Space>& data) {
    if constexpr (Space::dimension == 6) add_links(build_links(data.model), m > 0, lines);
  });
  if (m == 0) {
    lines.emplace_back(loops, std::string("none: no KKT system, no σ, forward dynamics by ") +
                                  (scene.lagrangian ? "factors of M" : "the two sweeps"));
    return lines;
  }
  lines.emplace_back(loops, scene.lagrangian ? std::to_string(m)
                                             : std::to_string(scene.loops.size()) + " with " +
                                                   std::to_string(m) + " equations");
  lines.emplace_back("solving (7)", mechanism.solver().in_words() + ", " +
                                        std::to_string(mechanism.nv() + m) + " unknowns");
  return lines;
}

}  // namespace momenta
