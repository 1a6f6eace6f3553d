#include <momenta/dae/kkt/factor/filtered_factor.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/topology/cut/cut_cost.h>

#include <algorithm>
#include <vector>

namespace momenta {

void TieGraph::tie(std::size_t a, std::size_t b) {
  if (a == b) return;
  ties_[a].push_back(b);
  ties_[b].push_back(a);
}

void TieGraph::settle() {
  for (auto& list : ties_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

std::vector<std::size_t> TieGraph::breadth_first(std::size_t first) const {
  std::vector<char> seen(count(), 0);
  std::vector<std::size_t> reached{first};
  seen[first] = 1;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    std::vector<std::size_t> next;
    for (const std::size_t one : ties(reached[i]))
      if (!seen[one]) next.push_back(one);
    std::stable_sort(next.begin(), next.end(),
                     [&](std::size_t a, std::size_t b) { return ties(a).size() < ties(b).size(); });
    for (const std::size_t one : next) seen[one] = 1;
    reached.insert(reached.end(), next.begin(), next.end());
  }
  return reached;
}

std::vector<std::size_t> TieGraph::from_an_end(std::size_t any) const {
  return breadth_first(breadth_first(breadth_first(any).back()).back());
}

namespace {

/// Bodies that the sweeps take one by one, where those of branches side by side in lanes count as
/// two and a half branches (find_looped_branches).
std::int64_t taken_one_by_one(const Model<Spatial>& model, const SweptLoops<Spatial>& swept) {
  constexpr int lanes = 8;
  auto twice = 2 * static_cast<std::int64_t>(model.bodies.size());
  if (!swept.plan.fits()) return twice / 2;
  const LinkTree links = build_links(model);
  for (const LoopedBranchGroup& g :
       find_looped_branches(links, swept.loops, swept.plan, lanes).groups)
    twice -= (2 * g.count - 5) * g.bodies;
  return twice / 2;
}
std::int64_t taken_one_by_one(const Model<Planar>& model, const SweptLoops<Planar>&) {
  return static_cast<std::int64_t>(model.bodies.size());
}

/// How the loops of a scene lie in its tree, L left out.
CutCost cost_in(const Tree& tree, const Scene& scene, const Plan& plan) {
  CutCost cost;
  std::vector<int> depth;
  for (const Tree::Body& b : tree.bodies) {
    depth.push_back(b.parent < 0 ? 1 : 1 + depth[static_cast<std::size_t>(b.parent)]);
    cost.depth = std::max(cost.depth, depth.back());
    cost.mass_entries += depth.back();
  }
  if (scene.loops.empty()) return cost;
  const auto take = [&](const auto& model) {
    const auto swept = swept_loops(tree, model, build_loops(scene, tree, model));
    cost.open = swept.plan.slots;
    cost.work = swept.plan.work;
    cost.sweeps = cost.work + taken_one_by_one(model, swept) * (plan.planar ? 4 : 15) *
                                  lanes_for(cost.open, plan.planar);
  };
  if (plan.planar)
    take(build_planar_model(tree, scene, plan.basis));
  else
    take(build_spatial_model(tree, scene));
  return cost;
}

}  // namespace

CutCost cut_cost(const Mechanism& mechanism) {
  CutCost cost = cost_in(mechanism.tree(), mechanism.scene(), mechanism.plan());
  if (mechanism.solver().kkt() == KktChoice::sparse && mechanism.solver().filters_pivots())
    cost.factor_entries =
        FilteredFactor(mechanism.kkt_pattern(), mechanism.nv(), mechanism.row_groups()).entries();
  return cost;
}

CutCost swept_cost(const Scene& scene, const Plan& plan) {
  return cost_in(build_valid_tree(scene), scene, plan);
}

bool better(const CutCost& a, const CutCost& b) {
  constexpr int most = LoopPlan::most_slots;
  if ((a.open > most) != (b.open > most)) return a.open <= most;
  // the bodies' own equations are the same whatever is cut
  if (a.open > most) return a.factor_entries > 0 && 100 * a.factor_entries < 90 * b.factor_entries;
  return 100 * a.sweeps < 98 * b.sweeps ||
         (100 * a.sweeps < 102 * b.sweeps && 4 * a.mass_entries < 3 * b.mass_entries);
}

}  // namespace momenta
