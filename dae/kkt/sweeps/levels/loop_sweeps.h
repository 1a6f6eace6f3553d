#pragma once
// The sweeps that carry loops, compiled for several x86-64 levels in one library and for several
// numbers of slots, and chosen when a mechanism is made.

#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/planar_joint.h>
#include <momenta/dae/kkt/sweeps/levels/looped_sweeps.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/mechanism/loop/carried_rows.h>
#include <momenta/dae/mechanism/loop/loop_model.h>
#include <momenta/dae/mechanism/loop/shared_points.h>

#include <memory>

namespace momenta {

/// Loops with points and axes in the frames of the links; in space these are the model's.
LoopModel<Planar> in_link_frames(LoopModel<Planar> loops, const PlanarTree& tree);
LoopModel<Spatial> in_link_frames(LoopModel<Spatial> loops, const LinkTree& tree);

/// Loops as the sweeps carry them.
template <class Space>
struct SweptLoops {
  LoopModel<Space> loops;  ///< points and axes in the frames of the links
  LoopPlan plan;           ///< the order in which bodies and loops are eliminated
  SharedPoints shared;     ///< not empty: ties paired anew, in the plane
  CarriedRows carried;     ///< not all: rows left out, in space
};

/// The plan of a model's loops; in space branches may be folded.
template <class Space>
LoopPlan plan_loops(const Model<Space>& model, const LoopModel<Space>& loops) {
  if (!loops.swept()) {
    LoopPlan none;
    none.linear = false;
    return none;
  }
  std::vector<int> parents;
  for (const auto& b : model.bodies) parents.push_back(b.parent);
  std::vector<LoopShape> shapes;
  for (const auto& l : loops.loops) {
    // Along axes 1 and 2 in this order: along a driven slot and across it they are 2 and 1.
    const bool pair = l.n_points == 2 && l.n_axes == 0 && l.points[0] == 0 && l.points[1] == 1;
    shapes.push_back({l.a, l.b, l.rows, pair});
    for (const auto& c : l.joints) shapes.back().joints.emplace_back(c.body, c.ratio);
  }
  // In a plane fronts are narrow, and the code that gathers costs more than lanes: rows of
  // four-bars took 8 to 12 % longer (AMD EPYC, Zen 5).
  constexpr bool in_space = Space::dimension == 6;
  return plan_loops(parents, shapes, in_space, in_space);
}

/// `loops` in the frames of the links and their plan. In space without the rows that no joint
/// moves; in a plane, ties that meet in one point are paired anew where that is less work and both
/// plans fit.
template <class Space>
SweptLoops<Space> swept_loops([[maybe_unused]] const Tree& tree, const Model<Space>& model,
                              LoopModel<Space> loops) {
  SweptLoops<Space> given{std::move(loops), {}, {}, {}};
  if constexpr (Space::dimension == 6) {
    given.carried = CarriedRows(tree, model, given.loops);
    given.plan = plan_loops(model, given.loops);
    return given;
  } else {
    given.plan = plan_loops(model, given.loops);
    std::vector<int> parents;
    for (const auto& b : model.bodies) parents.push_back(b.parent);
    SweptLoops<Space> anew;
    anew.shared = SharedPoints(parents, given.loops, anew.loops);
    if (anew.shared.empty()) return given;
    anew.plan = plan_loops(model, anew.loops);
    return given.plan.fits() && anew.plan.work < given.plan.work ? anew : given;
  }
}

/// `branches_side_by_side`: in space, of one state, folded branches of one shape
/// (branches/looped_branches.h).
/// @pre level_at_most(level) is level, swept.plan.fits(); tree and swept loops stay where they are.
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const PlanarTree& tree,
                                                 const SweptLoops<Planar>& swept, int level,
                                                 bool branches_side_by_side = true);
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const LinkTree& tree,
                                                 const SweptLoops<Spatial>& swept, int level,
                                                 bool branches_side_by_side = true);

}  // namespace momenta
