#pragma once
// Closed loops in space inside the two sweeps, as in the plane (planar_loop_sweeps.h), in the
// canonical frames and with the eliminations of the open chain's recursions. For a revolute joint,
//
//   c = C_nz, g = c M_j⁻¹, C' = C − h c, W' = W + c gᵀ, d' = d + g e
//
// and C' takes the same screws to the parent as D'. Momentum form: P* = M'V + D' + C'σ before the
// revolute joint's screw, ṗ = weight − Eᵀ(V × P*) + Eᵀ T*, T* the N − κ w of the loops below,
// gathered by a last sweep over the bodies on their ways. A loop's points, axes and velocities are
// in the axes of the body that closes it, as that stands, or of one nearer to the ground. Where no
// loop is open a body is taken as in a tree.
//
// A coupler's r joins C_nz where the revolute joint is eliminated, and leaves it with the opposite
// sign, as the revolute joint is eliminated by its absolute rate.
//
// Acceleration form: A = (acceleration of O, dω/dt) in body axes,
// the ground falls upward with −g, c the velocity products of acceleration_sweeps.h.

#include <momenta/core/kernel/place_links.h>
#include <momenta/core/kernel/rotor.h>
#include <momenta/core/kernel/spherical.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branch_pack.h>
#include <momenta/dae/kkt/sweeps/couplings.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/kkt/sweeps/slots/right_side.h>
#include <momenta/dae/kkt/sweeps/slots/spatial_loop_place.h>
#include <momenta/dae/kkt/sweeps/spatial_columns.h>
#include <momenta/dae/mechanism/loop/loops_in_time.h>

#include <algorithm>

namespace momenta {

template <class Space, class S, int Rows, bool Momentum>
class LoopSweeps;

/// Tree: LinkTree; or LoopedBranchTree, which holds the constants of several branches side by side.
template <class S, int Rows, bool Momentum, class Tree>
class SpatialLoopSweeps {
  using Column = Slots<S, Rows>;
  using Blocks = Front<S, Rows, 6>;
  using Row = ClosedRow<S, Rows, 6>;
  using Loops = typename LoopsOf<Tree>::Model;
  using Loop = typename Loops::Loop;
  static constexpr bool of_looped_branches = LoopsOf<Tree>::of_looped_branches;
  static constexpr bool takes_packs =
      !of_looped_branches && !std::is_void_v<typename LoopedBranchLanes<S>::type>;
  struct NoPack {};
  using Packs = typename std::conditional_t<
      takes_packs,
      std::type_identity<LoopedBranchPack<S, typename LoopedBranchLanes<S>::type, Momentum>>,
      std::type_identity<NoPack>>::type;
  using Motion = Spatial::Motion<S>;
  using Force = Spatial::Force<S>;

 public:
  static constexpr bool of_momenta = Momentum;

  /// `looped_branches`: to take side by side; null: none.
  SpatialLoopSweeps(const Tree& tree, const Loops& loops, const LoopPlan& plan,
                    const LoopedBranchGroups* looped_branches = nullptr);

  /// Momentum form: u (nv) and σ (m) of (7) from p; with right.rates ṗ (nv) of (8), forces between
  /// points of bodies left out. Acceleration form: u̇, λ from u and joint forces `tau` (nv). False
  /// when a joint's inertia is not positive: singular_joint(). O(bodies + m).
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& x, const In& tau, const RightSide<S>& right,
                  Out u, Out impulse, Out rate);

  /// Memory that an evaluation goes through [bytes].
  static std::size_t bytes(const Tree& tree, const Loops& loops) {
    return tree.links.size() * (sizeof(RevoluteRecord) + sizeof(LoopBody<S>) + sizeof(Force)) +
           loops.loops.size() * sizeof(SpatialLoopPlace<S>) +
           static_cast<std::size_t>(loops.rows) * sizeof(Row);
  }
  // Branches side by side: the three steps of operator() between which the body they fold into is
  // swept.

  /// From the pose of that body, and its velocities in acceleration form, to
  /// brought_by_looped_branches().
  template <class In>
  bool looped_branches_inward(const S& t, const In& q, const In& x, const In& tau,
                              const RightSide<S>& right, const LoopBody<S>& onto);
  const Articulated<S>& brought_by_looped_branches() const { return looped_branches_[0]; }
  /// From the motion V of that body, in its axes.
  template <class In, class Out>
  void looped_branches_outward(const In& q, const RightSide<S>& right, const Motion& V, Out u,
                               Out impulse, Out rate);
  /// From the velocities of that body in ground axes; the loops' N − κ w on it.
  template <class Out>
  const Force& looped_branches_rates(const Vec3<S>& v, const Vec3<S>& w, const RightSide<S>& right,
                                     const Out& impulse, Out rate);

  /// Sets what solutions add to d of the second row (m), where S has directions; null: nothing.
  void add_to_rows(const S* besides) { besides_ = besides; }
  int singular_joint() const { return singular_joint_; }
  /// Whether the last solution is wrong, as it closed a folded branch on too weak a pivot.
  bool weak_looped_branch() const { return weak_looped_branch_; }
  /// Whether the states or branches of a pack need several orders of closing rows: close_loop().
  bool uneven() const { return !even_; }
  /// Pivots of the last solution: calls report(row of Φ, w, τ).
  template <class Report>
  void each_pivot(Report&& report) const;
  /// The same with packs as they are: report(row of Φ, w, τ).
  template <class Report>
  void each_row(Report&& report) const;

 private:
  struct Carried {
    Articulated<S> articulated;
    Blocks blocks;
  };
  struct Moving {
    Motion V;
    Vec3<S> g;  ///< gravity (momentum form)
    Column sigma;
  };
  struct RevoluteRecord {
    RevoluteTurning<S> M;  ///< part of M'
    RevoluteColumn<S> h;
    S Dfx, Dfy, Dnx, Dny, y0, Gx, Gy, inverse;
    Column C[4], g;  ///< rows fx, fy, nx, ny of C'
    Motion c;        ///< acceleration form: velocity product, before the revolute joint's screw
  };
  struct SphericalRecord {
    Mat3<S> R;
    SphericalPivot<S> pivot;
    Sym3<S> A;
    Vec3<S> Df, p, G;
    Column C[3], g[3];  ///< force rows of C'; Δ⁻¹ L⁻¹ C_n
    Motion c;
  };
  struct AnyRecord {
    Column C[6], g[6];
    Motion given;  ///< Ω_t, or the velocity product and prescribed acceleration
  };

  const auto& body(std::size_t k) const { return tree_->model->bodies[k]; }
  /// Whether others sweep body k: a body of branches side by side, or, for branches, the body they
  /// fold into.
  bool elsewhere(std::size_t k) const {
    if constexpr (of_looped_branches)
      return k == 0;
    else
      return branches_apart_ && branches_apart_->bodies[k];
  }
  void sweep_apart(const LoopedBranchGroups* looped_branches) {
    branches_apart_ = looped_branches;
    swept_ = revolutes_.size();
    while (swept_ > 0 && elsewhere(swept_ - 1)) --swept_;
  }
  bool loop_elsewhere(std::size_t i) const { return branches_apart_ && branches_apart_->loops[i]; }
  const LoopBody<S>* loop_body(int k) const {
    return k < 0 ? nullptr : &bodies_[static_cast<std::size_t>(k)];
  }

  /// Takes the motion of a body with ends of loops, or with branches that have some, from its own
  /// axes to those of poses.
  MOMENTA_INLINE void set_velocity(std::size_t k, const Motion& V) {
    const LoopPlan::Range ends = plan_->ends_of[k];
    if (ends.first == ends.last && !plan_->takes_branches[k]) return;
    LoopBody<S>& to = bodies_[k];
    const bool moved = plan_->posed[k] == OnWay::moved;
    to.v = moved ? to.pose.axes * V.v : V.v;
    to.w = moved ? to.pose.axes * V.w : V.w;
  }

  const PrescribedMotion<S>& prescribed(const Loop& l) const {
    return moving_[static_cast<std::size_t>(l.motion)];
  }
  typename SpatialLoopPlace<S>::Rates rates_of(const Loop& l, const SpatialLoopPlace<S>& s) const {
    auto rates = s.motion(loop_body(l.a), loop_body(l.b));
    s.add_points(loop_body(l.b), rates);
    if (l.motion >= 0) s.add_prescribed(prescribed(l), rates);
    return rates;
  }
  /// The rates that N needs.
  MOMENTA_INLINE typename SpatialLoopPlace<S>::Rates motion_of(const Loop& l,
                                                               const SpatialLoopPlace<S>& s) const {
    auto rates = s.motion(loop_body(l.a), loop_body(l.b));
    if (l.is_distance()) s.add_points(loop_body(l.b), rates);
    if (l.motion >= 0) s.add_prescribed(prescribed(l), rates);
    return rates;
  }

  template <class In, class Out>
  bool evaluate(const S& t, const In& q, const In& x, const In& tau, const RightSide<S>& right,
                Out u, Out impulse, Out rate);
  template <class In>
  bool place(const S& t, const In& q, const In& x, const RightSide<S>& right);
  template <class In>
  void place_loops(const In& q, const In& x, const RightSide<S>& right);
  template <class In>
  void move_bodies(const In& x, const RightSide<S>& right);
  void pose_bodies();
  template <class In>
  bool inward(const In& r, const RightSide<S>& right);
  void enter(std::size_t k, const LoopPlan::Range& range, const RightSide<S>& right, Carried& a);
  void enter(std::size_t k, const LoopPlan::End& end, const RightSide<S>& right, Carried& a);
  void enter_right_side(std::size_t loop, const RightSide<S>& right, Column& d);
  __attribute__((noinline)) void fold(std::size_t root, const RightSide<S>& right,
                                      Carried& looped_branch);
  __attribute__((noinline)) void close(int loop, Carried& a, double fade, SlotGroups all);
  template <class In>
  bool revolute_inward(std::size_t k, const In& r, const RightSide<S>& right, Carried& a);
  template <class In>
  __attribute__((noinline)) bool spherical_inward(std::size_t k, const In& r, Carried& a);
  void spherical_columns_inward(SphericalRecord& w, const Vec3<S>& step, SlotGroups open,
                                Blocks& o);
  template <class In>
  __attribute__((noinline)) bool axis_inward(std::size_t k, const In& r, const RightSide<S>& right,
                                             Carried& a);
  template <class In>
  bool tree_inward(std::size_t k, const In& r, Carried& a, S* own,
                   Spatial::ArticulatedInertia<S>& M, Force& D);
  template <class In>
  __attribute__((noinline)) bool free_inward(std::size_t k, const In& r, Carried& a);
  template <class In>
  __attribute__((noinline)) bool user_inward(std::size_t k, const In& r, Carried& a);
  void columns_inward(std::size_t k, SlotGroups open, Blocks& o) const;
  bool hand_on(std::size_t k, const Spatial::ArticulatedInertia<S>& M, const Force& D,
               Carried& a) const;
  /// xᵀσ over the slots open above body k.
  MOMENTA_INLINE S along_sigma(std::size_t k, const Column& x, const Column& sigma) const {
    const SlotGroups open = open_slots_.fronts[k].open;
    return open ? plus_dot(S(0.0), x, sigma, open) : S(0.0);
  }
  /// −Eᵀ(W × C'σ) of a revolute joint.
  MOMENTA_INLINE S turning_along(std::size_t k, const Column (&C)[4], const Vec3<S>& v,
                                 const Vec3<S>& o, const Column& sigma) const {
    if (!open_slots_.fronts[k].open) return S(0.0);
    Column turned;
    each_open<S, Rows>(open_slots_.fronts[k].open, [&](auto i) MOMENTA_INLINED {
      turned.v[i] = C[0].v[i] * Column::all(v[1]) - C[1].v[i] * Column::all(v[0]) +
                    C[2].v[i] * Column::all(o[1]) - C[3].v[i] * Column::all(o[0]);
    });
    return along_sigma(k, turned, sigma);
  }
  template <class Out>
  void solve_loops(const LoopPlan::Range& range, const RightSide<S>& right, const Motion* motion,
                   Column& sigma, Out& out);
  template <class In, class Out>
  void outward(const In& q, const RightSide<S>& right, Out u, Out impulse, Out rate);
  template <class In, class Out>
  void revolute_outward(std::size_t k, const In& q, bool rates, Moving& m, Out u, Out rate);
  template <class Out>
  __attribute__((noinline)) void spherical_outward(std::size_t k, bool rates, Moving& m, Out u,
                                                   Out rate);
  template <class In, class Out>
  __attribute__((noinline)) void axis_outward(std::size_t k, const In& q, bool rates, Moving& m,
                                              Out u, Out rate);
  template <class Out>
  __attribute__((noinline)) void free_outward(std::size_t k, bool rates, Moving& m, Out u,
                                              Out rate);
  template <class Out>
  __attribute__((noinline)) void user_outward(std::size_t k, bool rates, Moving& m, Out u,
                                              Out rate);
  Force net_wrench(std::size_t k, const Moving& m, Force& P) const;
  template <class Out>
  void axes_rates(std::size_t k, const Moving& m, Out rate) const;
  template <class Out>
  void rates_inward(const RightSide<S>& right, const Out& impulse, Out rate);

  const Tree* tree_;
  typename LoopsOf<Tree>::InTime in_time_;
  const Loops* loops_;  ///< at the current time
  const LoopPlan* plan_;
  OpenSlots open_slots_;
  Angles<S> angles_;
  std::vector<RevoluteRecord> revolutes_;
  std::vector<SphericalRecord> sphericals_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<AnyRecord> any_;
  std::vector<LoopBody<S>> bodies_;
  std::vector<Force> wrenches_;  ///< in the axes of poses, about O; in acceleration form Ω
  std::vector<SpatialLoopPlace<S>> places_;
  std::vector<PrescribedMotion<S>> moving_;  ///< by motion
  std::vector<S> coupled_;                   ///< by loop: d of a coupler
  Carried front_{}, ground_{};               ///< the sweep under way, and where roots are gathered
  std::vector<Carried> slots_;
  std::vector<Moving> outward_slots_;
  std::vector<Row> rows_;
  std::vector<Articulated<S>> looped_branches_;  ///< by body: what folded branches add to it
  std::vector<Motion> taken_;                    ///< by body: Ω of those that take branches
  const S* compliance_ = nullptr;                ///< right.compliance of the call under way
  const S* besides_ = nullptr;                   ///< add_to_rows()
  std::vector<std::unique_ptr<Packs>> packs_;
  const LoopedBranchGroups* branches_beside_ = nullptr;  ///< held by packs_
  const LoopedBranchGroups* branches_apart_ = nullptr;   ///< while packs_ sweep
  std::size_t swept_;  ///< bodies up to the last not swept elsewhere
  int singular_joint_ = -1;
  bool weak_looped_branch_ = false, even_ = true;
};

template <class S, int Rows, bool Momentum>
class LoopSweeps<Spatial, S, Rows, Momentum>
    : public SpatialLoopSweeps<S, Rows, Momentum, LinkTree> {
 public:
  using SpatialLoopSweeps<S, Rows, Momentum, LinkTree>::SpatialLoopSweeps;
};

template <class S, int Rows, bool Momentum, class Tree>
SpatialLoopSweeps<S, Rows, Momentum, Tree>::SpatialLoopSweeps(
    const Tree& tree, const Loops& loops, const LoopPlan& plan,
    const LoopedBranchGroups* looped_branches)
    : tree_(&tree),
      in_time_(loops),
      loops_(&loops),
      plan_(&plan),
      open_slots_(plan, parents_of(tree), rows_of(loops)),
      angles_(tree.links.size()),
      revolutes_(tree.links.size()),
      sphericals_(tree.sphericals.size()),
      joints_(static_cast<std::size_t>(tree.records)),
      users_(static_cast<std::size_t>(tree.users)),
      any_(static_cast<std::size_t>(tree.records)),
      bodies_(tree.links.size()),
      wrenches_(tree.links.size()),
      places_(loops.loops.size()),
      moving_(loops.motions.size()),
      coupled_(plan.couples() ? loops.loops.size() : 0),
      slots_(static_cast<std::size_t>(tree.slots)),
      outward_slots_(static_cast<std::size_t>(tree.slots)),
      rows_(static_cast<std::size_t>(loops.rows)),
      swept_(tree.links.size()) {
  for (LoopBody<S>& body : bodies_) body.pose.axes = identity3<S>();  // bodies at rest
  for (const char takes : plan.takes_branches)
    if (takes && looped_branches_.empty()) {
      looped_branches_.resize(tree.links.size());
      taken_.resize(tree.links.size());
    }
  if constexpr (takes_packs)
    if (looped_branches && !looped_branches->groups.empty()) {
      branches_beside_ = looped_branches;
      for (const LoopedBranchGroup& group : looped_branches->groups)
        packs_.push_back(std::make_unique<Packs>(tree, loops, group));
    }
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In, class Out>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::operator()(const S& t, const In& q, const In& x,
                                                            const In& tau,
                                                            const RightSide<S>& right, Out u,
                                                            Out impulse, Out rate) {
  if (branches_apart_ != branches_beside_) sweep_apart(branches_beside_);
  return evaluate(t, q, x, tau, right, u, impulse, rate);
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In, class Out>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::evaluate(const S& t, const In& q, const In& x,
                                                          const In& tau, const RightSide<S>& right,
                                                          Out u, Out impulse, Out rate) {
  if (!place(t, q, x, right)) return false;
  if constexpr (takes_packs)
    for (auto& pack : packs_) {
      const auto onto = static_cast<std::size_t>(pack->onto());
      if (branches_apart_ &&
          pack->inward(t, q, x, tau, right, bodies_[onto], looped_branches_[onto])) {
        weak_looped_branch_ |= pack->weak_looped_branch();
        continue;
      }
      // One by one: finds the joint without inertia, or takes each branch in its own order.
      if (!branches_apart_) break;
      sweep_apart(nullptr);
      return evaluate(t, q, x, tau, right, u, impulse, rate);
    }
  if (!inward(Momentum ? x : tau, right)) return false;
  outward(q, right, u, impulse, rate);
  if constexpr (takes_packs)
    if (branches_apart_)
      for (auto& pack : packs_)
        pack->outward(taken_[static_cast<std::size_t>(pack->onto())], u, impulse);
  if (Momentum && right.rates) rates_inward(right, impulse, rate);
  return true;
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::looped_branches_inward(const S& t, const In& q,
                                                                        const In& x, const In& tau,
                                                                        const RightSide<S>& right,
                                                                        const LoopBody<S>& onto) {
  bodies_[0] = onto;
  return place(t, q, x, right) && inward(Momentum ? x : tau, right);
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In, class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::looped_branches_outward(const In& q,
                                                                         const RightSide<S>& right,
                                                                         const Motion& V, Out u,
                                                                         Out impulse, Out rate) {
  taken_[0] = V;
  outward(q, right, u, impulse, rate);
}

template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
auto SpatialLoopSweeps<S, Rows, Momentum, Tree>::looped_branches_rates(const Vec3<S>& v,
                                                                       const Vec3<S>& w,
                                                                       const RightSide<S>& right,
                                                                       const Out& impulse, Out rate)
    -> const Force& {
  bodies_[0].v = v;
  bodies_[0].w = w;
  rates_inward(right, impulse, rate);
  return wrenches_[0];
}

}  // namespace momenta

#include <momenta/dae/kkt/sweeps/spatial_loop_axes.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_inward.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_joints.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_outward.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_placing.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_user.h>
