#include <momenta/core/kernel/levels/at_level.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <cmath>
#include <utility>

namespace momenta {

template <int Level, class Space, class Tree>
std::unique_ptr<LoopedSweeps> looped_sweeps_at(const Tree& tree, const SweptLoops<Space>& swept,
                                               LoopedBranchGroups looped_branches);

namespace {

template <class Space, class Tree>
std::unique_ptr<LoopedSweeps> make(const Tree& tree, const SweptLoops<Space>& swept, int level,
                                   LoopedBranchGroups looped_branches) {
  return at_level(level, [&]<int Level>() {
    return looped_sweeps_at<Level>(tree, swept, std::move(looped_branches));
  });
}

}  // namespace

std::unique_ptr<LoopedSweeps> make_looped_sweeps(const PlanarTree& tree,
                                                 const SweptLoops<Planar>& swept, int level, bool) {
  return make(tree, swept, level, {});
}
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const LinkTree& tree,
                                                 const SweptLoops<Spatial>& swept, int level,
                                                 bool branches_side_by_side) {
  return make(tree, swept, level,
              branches_side_by_side ? find_looped_branches(tree, swept.loops, swept.plan,
                                                           looped_branch_lanes_at(level))
                                    : LoopedBranchGroups{});
}

LoopModel<Spatial> in_link_frames(LoopModel<Spatial> loops, const LinkTree&) {
  return loops;
}
LoopModel<Planar> in_link_frames(LoopModel<Planar> loops, const PlanarTree& tree) {
  const auto turn = [&](int body, Vec2<double>& v) {
    if (body < 0) return;
    const double angle = tree.frame_turn[static_cast<std::size_t>(body)];
    const double c = std::cos(angle), s = std::sin(angle);
    v = {{c * v[0] + s * v[1], c * v[1] - s * v[0]}};
  };
  for (auto& l : loops.loops) {
    turn(l.a, l.at_a);
    turn(l.b, l.at_b);
    for (auto& axis : l.axis_a) turn(l.a, axis);
    for (auto& axis : l.axis_b) turn(l.axes_of_b(), axis);
    if (l.motion < 0) continue;
    auto& m = loops.motions[static_cast<std::size_t>(l.motion)];
    turn(l.b, m.at_b);
    for (auto& axis : m.axis_a) turn(l.a, axis);
    for (auto& axis : m.axis_b) turn(l.b, axis);
    for (auto& translation : m.translations) turn(l.b, translation.along);
  }
  return loops;
}

}  // namespace momenta
