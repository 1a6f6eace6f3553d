#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>

#include <algorithm>
#include <map>

namespace momenta {
namespace {

/// Joints and loops of a branch as numbers, equal for branches of one shape.
using LoopedBranchShape = std::vector<int>;

struct LoopedBranch {
  int root = 0, end = 0;   ///< its bodies: [root, end)
  std::vector<int> loops;  ///< indices in the model
  bool fits = true;        ///< may be taken beside others
};

bool is_slide(const Model<Spatial>::Body& b) {
  return b.kind == JointKind::prismatic && b.drive < 0 && b.nv == 1;
}

LoopedBranchShape shape_of(const LinkTree& tree, const LoopModel<Spatial>& loops,
                           const LoopedBranch& looped_branch, int onto) {
  LoopedBranchShape shape{onto, looped_branch.end - looped_branch.root};
  for (int k = looped_branch.root; k < looped_branch.end; ++k)
    shape.push_back(tree.links[static_cast<std::size_t>(k)].kind == LinkKind::revolute);
  for (const int i : looped_branch.loops) {
    const auto& l = loops.loops[static_cast<std::size_t>(i)];
    const bool on_a = l.b == onto;
    shape.insert(shape.end(), {(on_a ? l.a : l.b) - looped_branch.root, on_a, l.is_distance(),
                               l.n_points, l.n_axes});
    shape.insert(shape.end(), l.points.begin(), l.points.end());
    for (const auto& [x, y] : l.axes) shape.insert(shape.end(), {x, y});
  }
  return shape;
}

LoopPlan plan_of(const LoopModel<Spatial>& loops, const LoopedBranch& looped_branch, int onto) {
  std::vector<int> parents{-1, -1};
  for (int k = looped_branch.root + 1; k < looped_branch.end; ++k)
    parents.push_back(k - looped_branch.root);
  const auto here = [&](int body) { return body == onto ? 0 : body - looped_branch.root + 1; };
  std::vector<LoopShape> shapes;
  for (const int i : looped_branch.loops) {
    const auto& l = loops.loops[static_cast<std::size_t>(i)];
    shapes.push_back({here(l.a), here(l.b), l.rows});
  }
  return plan_folded(parents, shapes);
}

/// Folded branches by root.
std::map<int, LoopedBranch> folded_looped_branches(const LinkTree& tree,
                                                   const LoopModel<Spatial>& loops,
                                                   const LoopPlan& plan) {
  std::map<int, LoopedBranch> looped_branches;
  std::vector<int> looped_branch_of(tree.links.size(), -1);
  for (std::size_t k = 0; k < tree.links.size(); ++k) {
    const Link& l = tree.links[k];
    const int here = static_cast<int>(k);
    looped_branch_of[k] = l.parent >= 0 ? looped_branch_of[static_cast<std::size_t>(l.parent)]
                          : plan.folded_onto[k] >= 0 ? here
                                                     : -1;
    if (looped_branch_of[k] < 0) continue;
    LoopedBranch& looped_branch = looped_branches[looped_branch_of[k]];
    looped_branch.root = looped_branch_of[k];
    looped_branch.end = here + 1;
    looped_branch.fits = looped_branch.fits && (here == looped_branch.root || l.first) &&
                         (l.kind == LinkKind::revolute || is_slide(tree.model->bodies[k])) &&
                         !tree.model->bodies[k].stop.acts();  // lanes have no stops
  }
  for (std::size_t i = 0; i < loops.loops.size(); ++i) {
    const auto& l = loops.loops[i];
    for (const int end : {l.a, l.b}) {
      if (end < 0 || looped_branch_of[static_cast<std::size_t>(end)] < 0) continue;
      LoopedBranch& looped_branch =
          looped_branches[looped_branch_of[static_cast<std::size_t>(end)]];
      const int onto = plan.folded_onto[static_cast<std::size_t>(looped_branch.root)];
      looped_branch.fits =
          looped_branch.fits && (end == l.a ? l.b : l.a) == onto && l.motion < 0 && !l.is_coupler();
      looped_branch.loops.push_back(static_cast<int>(i));
    }
  }
  return looped_branches;
}

}  // namespace

LoopedBranchGroups::LoopedBranchGroups() = default;
LoopedBranchGroups::~LoopedBranchGroups() = default;
LoopedBranchGroups::LoopedBranchGroups(LoopedBranchGroups&&) noexcept = default;

LoopedBranchGroups find_looped_branches(const LinkTree& tree, const LoopModel<Spatial>& loops,
                                        const LoopPlan& plan, int lanes) {
  // A pack of any number of branches costs as much as two and a half branches one by one.
  constexpr int least = 3;
  LoopedBranchGroups all;
  std::map<LoopedBranchShape, std::vector<const LoopedBranch*>> shapes;
  const auto looped_branches = folded_looped_branches(tree, loops, plan);
  for (const auto& [root, looped_branch] : looped_branches) {
    int rows = 0;
    for (const int i : looped_branch.loops) rows += loops.loops[static_cast<std::size_t>(i)].rows;
    if (looped_branch.fits && rows <= most_looped_branch_rows)
      shapes[shape_of(tree, loops, looped_branch, plan.folded_onto[static_cast<std::size_t>(root)])]
          .push_back(&looped_branch);
  }
  all.bodies.assign(tree.links.size(), 0);
  all.loops.assign(loops.loops.size(), 0);
  for (const auto& [shape, alike] : shapes) {
    const int total = static_cast<int>(alike.size());
    for (int first = 0; first < total; first += lanes) {
      const int count = std::min(lanes, total - first);
      if (count < std::min(least, lanes)) break;
      const auto looped_branch = [&, &looped_branches_of_shape = alike](int lane) {
        return *looped_branches_of_shape[static_cast<std::size_t>(first +
                                                                  std::min(lane, count - 1))];
      };
      LoopedBranchGroup g;
      g.onto = shape.front();
      g.lanes = lanes;
      g.count = count;
      g.bodies = looped_branch(0).end - looped_branch(0).root;
      g.loops = static_cast<int>(looped_branch(0).loops.size());
      for (int lane = 0; lane < lanes; ++lane) {
        g.roots.push_back(looped_branch(lane).root);
        for (int k = looped_branch(lane).root; k < looped_branch(lane).end; ++k)
          all.bodies[static_cast<std::size_t>(k)] = 1;
      }
      for (int i = 0; i < g.loops; ++i) {
        for (int lane = 0; lane < lanes; ++lane) {
          g.loop.push_back(looped_branch(lane).loops[static_cast<std::size_t>(i)]);
          all.loops[static_cast<std::size_t>(g.loop.back())] = 1;
        }
      }
      g.plan = plan_of(loops, looped_branch(0), g.onto);
      all.groups.push_back(std::move(g));
    }
  }
  return all;
}

std::string looped_branches_in_words(const LoopedBranchGroups& looped_branches) {
  std::string words;
  for (const LoopedBranchGroup& g : looped_branches.groups)
    words += (words.empty() ? "" : ", ") + std::to_string(g.count) + " branches of " +
             std::to_string(g.bodies) + (g.bodies == 1 ? " body" : " bodies") +
             " side by side in " + std::to_string(g.lanes) + " lanes";
  return words;
}

}  // namespace momenta
