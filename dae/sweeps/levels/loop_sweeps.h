#pragma once
// The sweeps that carry loops, compiled for several x86-64 levels in one library and for several
// numbers of slots, and chosen when a mechanism is made.

#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/planar_link.h>
#include <momenta/dae/loop/loop_model.h>
#include <momenta/dae/loop/shared_points.h>
#include <momenta/dae/sweeps/slots/loop_plan.h>
#include <momenta/dae/sweeps/slots/right_side.h>

#include <limits>
#include <memory>

namespace momenta {

/// States side by side: coordinate i of state s is at base[i * stride + s].
struct LoopedStates {
  const double* q;        ///< nq rows
  const double* p;        ///< nv rows
  double* u;              ///< nv rows
  double* sigma;          ///< m rows
  double* pdot;           ///< nv rows
  std::ptrdiff_t stride;  ///< from one row to the next
  std::size_t count;      ///< how many states
};

/// The sweeps that carry the loops of one mechanism, with their workspace: one object a thread.
/// Made by Mechanism::looped_sweeps().
class LoopedSweeps {
 public:
  virtual ~LoopedSweeps() = default;

  /// u (nv) and σ (m) of (7) from p (nv); with right.rates ṗ (nv) of (8), forces between points of
  /// bodies left out. False when a joint has no inertia: singular_joint().
  virtual bool momentum(double t, const double* q, const double* p, const RightSide<double>& right,
                        double* u, double* sigma, double* pdot) = 0;
  /// u̇ (nv) and λ (m) of (3) from u and all generalised forces τ (nv) but the weights'.
  /// @pre No compliance where ties are paired anew, here and in momentum().
  virtual bool acceleration(double t, const double* q, const double* u, const double* tau,
                            const RightSide<double>& right, double* udot, double* lambda) = 0;
  /// momentum() with rates for many states, `width()` at a time; no centre. False when some state
  /// has a joint without inertia.
  virtual bool momentum(double t, const LoopedStates& states, double fade, double leak) = 0;

  /// Rows of Φ that faded in the last solution of one state: that of momentum(), or acceleration().
  /// Returns their number; `rows` has room for m.
  virtual std::size_t faded_rows(int* rows, bool of_momentum) const = 0;
  /// The weakest pivot of that solution which has not faded, over τ, and how many have.
  struct Pivots {
    double weakest = std::numeric_limits<double>::infinity();  ///< none: infinite
    int faded = 0;                                             ///< how many
  };
  /// Of the last momentum(), or acceleration(), of one state.
  virtual Pivots pivots(bool of_momentum) const = 0;
  virtual int slots() const = 0;  ///< equations open at once, at most
  virtual int width() const = 0;  ///< states side by side
  /// Place in u of the joint at which the last call failed.
  virtual int singular_joint() const = 0;
  /// Whether the last call closed a folded branch, of one state or of some of many, on too weak a
  /// pivot: its solution is then wrong.
  virtual bool weak_looped_branch() const = 0;
};

/// The same loops with points and axes in the frames of the links. In space these are the model's.
LoopModel<Planar> in_link_frames(LoopModel<Planar> loops, const PlanarTree& tree);
/// The same in space.
LoopModel<Spatial> in_link_frames(LoopModel<Spatial> loops, const LinkTree& tree);

/// Loops as the sweeps carry them.
template <class Space>
struct SweptLoops {
  LoopModel<Space> loops;  ///< points and axes in the frames of the links
  LoopPlan plan;           ///< the order in which bodies and loops are eliminated
  SharedPoints shared;     ///< empty: the loops are those of the scene
};

/// The plan of a model's loops; in space branches may be folded.
template <class Space>
LoopPlan plan_loops(const Model<Space>& model, const LoopModel<Space>& loops) {
  std::vector<int> parents;
  for (const auto& b : model.bodies) parents.push_back(b.parent);
  std::vector<LoopShape> shapes;
  for (const auto& l : loops.loops) {
    shapes.push_back({l.a, l.b, l.rows, l.n_points == 2 && l.n_axes == 0});
    for (const auto& c : l.joints) shapes.back().joints.emplace_back(c.body, c.ratio);
  }
  return plan_loops(parents, shapes, Space::dimension == 6);
}

/// `loops` in the frames of the links and their plan; ties that meet in one point are paired anew
/// where that is less work and both plans fit.
template <class Space>
SweptLoops<Space> swept_loops(const Model<Space>& model, LoopModel<Space> loops) {
  SweptLoops<Space> given{std::move(loops), {}, {}}, anew;
  given.plan = plan_loops(model, given.loops);
  std::vector<int> parents;
  for (const auto& b : model.bodies) parents.push_back(b.parent);
  anew.shared = SharedPoints(parents, given.loops, anew.loops);
  if (anew.shared.empty()) return given;
  anew.plan = plan_loops(model, anew.loops);
  return given.plan.fits() && anew.plan.work < given.plan.work ? anew : given;
}

/// `branches_side_by_side`: in space, of one state, folded branches of one shape
/// (branches/branches.h).
/// @pre level_at_most(level) is level, swept.plan.fits(); tree and swept loops stay where they are.
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const PlanarTree& tree,
                                                 const SweptLoops<Planar>& swept, int level,
                                                 bool branches_side_by_side = true);
/// The same in space.
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const LinkTree& tree,
                                                 const SweptLoops<Spatial>& swept, int level,
                                                 bool branches_side_by_side = true);

}  // namespace momenta
