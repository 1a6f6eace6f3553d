#pragma once
// Closed loops in space inside the two sweeps, as in the plane (planar_loop_sweeps.h), in the
// canonical frames and with the eliminations of the open chain's recursions. For a pin,
//
//   c = C_nz, g = c M_j⁻¹, C' = C − h c, W' = W + c gᵀ, d' = d + g e
//
// and C' takes the same screws to the parent as D'. Momentum form: P* = M'V + D' + C'σ before the
// pin's screw, ṗ = weight − Eᵀ(V × P*) + Eᵀ T*, T* the N − κ w of the loops below, gathered by a
// last sweep over the bodies on their ways. A coupler's r joins C_nz where the pin is eliminated,
// and leaves it with the opposite sign, as the pin is eliminated by its absolute rate. Acceleration
// form: A = (acceleration of O, dω/dt) in body axes, the ground falls upward with −g, c the
// velocity products of acceleration_sweeps.h.

#include <momenta/core/kernel/ball.h>
#include <momenta/core/kernel/place_links.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/loop/loops_in_time.h>
#include <momenta/dae/sweeps/couplings.h>
#include <momenta/dae/sweeps/loop_plan.h>
#include <momenta/dae/sweeps/right_side.h>
#include <momenta/dae/sweeps/spatial_columns.h>
#include <momenta/dae/sweeps/spatial_loop_place.h>

namespace momenta {

template <class Space, class S, int Rows, bool Momentum>
class LoopSweeps;

template <class S, int Rows, bool Momentum>
class LoopSweeps<Spatial, S, Rows, Momentum> {
  using Column = Lanes<S, Rows>;
  using Blocks = Front<S, Rows, 6>;
  using Row = ClosedRow<S, Rows, 6>;
  using Loop = LoopModel<Spatial>::Loop;
  using Motion = Spatial::Motion<S>;
  using Force = Spatial::Force<S>;

 public:
  LoopSweeps(const LinkTree& tree, const LoopModel<Spatial>& loops, const LoopPlan& plan);

  /// Momentum form: u (nv) and σ (m) of (7) from p; with right.rates ṗ (nv) of (8), forces between
  /// points of bodies left out. Acceleration form: u̇, λ from u and joint forces `tau` (nv). False
  /// when a joint's inertia is not positive: stuck(). O(bodies + m).
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& x, const In& tau, const RightSide<S>& right,
                  Out u, Out impulse, Out rate);

  /// What an evaluation goes through in memory.
  static std::size_t bytes(const LinkTree& tree, const LoopModel<Spatial>& loops) {
    return tree.links.size() * (sizeof(PinRecord) + sizeof(LoopBody<S>) + sizeof(Force)) +
           loops.loops.size() * sizeof(SpatialLoopPlace<S>) +
           static_cast<std::size_t>(loops.rows) * sizeof(Row);
  }
  int stuck() const { return stuck_; }
  /// Whether the last solution closed a folded leg on too weak a pivot: it is then wrong.
  bool weak_leg() const { return weak_leg_; }
  /// Pivots of the last solution: calls report(row of Φ, w, τ).
  template <class Report>
  void each_pivot(Report&& report) const;

 private:
  struct Carried {
    Cargo<S> cargo;
    Blocks blocks;
  };
  struct Moving {
    Motion V;
    Vec3<S> g;  ///< gravity (momentum form)
    Column sigma;
  };
  struct PinRecord {
    Reduced<S> M;  ///< M' after the pin's screw
    PinColumn<S> h;
    S Dfx, Dfy, Dnx, Dny, y0, Gx, Gy;
    Column C[4], g;  ///< rows fx, fy, nx, ny of C' after the pin's screw
    Motion c;        ///< acceleration form: velocity product, before the pin's screw
  };
  struct BallRecord {
    Mat3<S> R;
    BallPivot<S> pivot;
    Sym3<S> A;
    Vec3<S> Df, p, G;
    Column C[3], g[3];  ///< force rows of C'; Δ⁻¹ L⁻¹ C_n
    Motion c;
  };
  struct AnyRecord {
    Column C[6], g[6];
    Motion given;  ///< Ω_t, or the velocity product and prescribed acceleration
  };

  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  const LoopBody<S>* loop_body(int k) const {
    return k < 0 ? nullptr : &bodies_[static_cast<std::size_t>(k)];
  }
  Force wrench_to_parent(std::size_t k, Force f) const;

  const PrescribedMotion<S>& prescribed(const Loop& l) const {
    return moving_[static_cast<std::size_t>(l.motion)];
  }
  typename SpatialLoopPlace<S>::Rates rates_of(const Loop& l, const SpatialLoopPlace<S>& s) const {
    auto rates = s.rates(loop_body(l.a), loop_body(l.b));
    if (l.motion >= 0) s.add_prescribed(prescribed(l), rates);
    return rates;
  }

  template <class In>
  void place_loops(const In& q, const In& x, const RightSide<S>& right);
  template <class In>
  void move_bodies(const In& x, const RightSide<S>& right);
  void pose_bodies();
  template <class In>
  bool inward(const In& r, const RightSide<S>& right);
  void enter(std::size_t k, const RightSide<S>& right, Carried& a);
  void enter(std::size_t k, const LoopPlan::End& end, const RightSide<S>& right, Carried& a);
  __attribute__((noinline)) void fold(std::size_t root, const RightSide<S>& right, Carried& leg);
  __attribute__((noinline)) void close(int loop, Carried& a, double fade, LaneGroups all);
  template <class In>
  bool pin_inward(std::size_t k, const In& r, const RightSide<S>& right, Carried& a);
  template <class In>
  __attribute__((noinline)) bool ball_inward(std::size_t k, const In& r, Carried& a);
  template <class In>
  __attribute__((noinline)) bool axis_inward(std::size_t k, const In& r, const RightSide<S>& right,
                                             Carried& a);
  template <class In>
  __attribute__((noinline)) bool free_inward(std::size_t k, const In& r, Carried& a);
  /// xᵀσ over the lanes open above body k.
  MOMENTA_INLINE S along_sigma(std::size_t k, const Column& x, const Column& sigma) const {
    return plus_dot(S(0.0), x, sigma, lanes_.fronts[k].open);
  }
  template <class Out>
  void solve_loops(const LoopPlan::Range& range, const RightSide<S>& right, const Motion* motion,
                   Column& sigma, Out& out);
  template <class In, class Out>
  void outward(const In& q, const RightSide<S>& right, Out u, Out impulse, Out rate);
  template <class In, class Out>
  void pin_outward(std::size_t k, const In& q, bool rates, Moving& m, Out u, Out rate);
  template <class Out>
  __attribute__((noinline)) void ball_outward(std::size_t k, bool rates, Moving& m, Out u,
                                              Out rate);
  template <class In, class Out>
  __attribute__((noinline)) void axis_outward(std::size_t k, const In& q, bool rates, Moving& m,
                                              Out u, Out rate);
  template <class Out>
  __attribute__((noinline)) void free_outward(std::size_t k, bool rates, Moving& m, Out u,
                                              Out rate);
  template <class Out>
  void rates_inward(const RightSide<S>& right, const Out& impulse, Out rate);

  const LinkTree* tree_;
  LoopsInTime<Spatial> in_time_;
  const LoopModel<Spatial>* loops_;  ///< at the time
  const LoopPlan* plan_;
  OpenLanes lanes_;
  Angles<S> angles_;
  std::vector<PinRecord> pins_;
  std::vector<BallRecord> balls_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<AnyRecord> any_;
  std::vector<LoopBody<S>> bodies_;
  std::vector<Force> wrenches_;
  std::vector<SpatialLoopPlace<S>> places_;
  std::vector<PrescribedMotion<S>> moving_;  ///< by motion
  std::vector<S> coupled_;                   ///< by loop: d of a coupler
  std::vector<Carried> slots_;
  std::vector<Moving> outward_slots_;
  std::vector<Row> rows_;
  std::vector<Cargo<S>> legs_;     ///< by body: what folded legs add to it
  std::vector<Motion> taken_;      ///< by body: Ω of those that take legs
  const S* compliance_ = nullptr;  ///< of the call under way: right.compliance
  int stuck_ = -1;
  bool weak_leg_ = false;
};

template <class S, int Rows, bool Momentum>
LoopSweeps<Spatial, S, Rows, Momentum>::LoopSweeps(const LinkTree& tree,
                                                   const LoopModel<Spatial>& loops,
                                                   const LoopPlan& plan)
    : tree_(&tree),
      in_time_(loops),
      loops_(&loops),
      plan_(&plan),
      lanes_(plan, parents_of(tree), rows_of(loops)),
      angles_(tree.links.size()),
      pins_(tree.links.size()),
      balls_(tree.balls.size()),
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
      rows_(static_cast<std::size_t>(loops.rows)) {
  for (const char takes : plan.takes_legs)
    if (takes && legs_.empty()) {
      legs_.resize(tree.links.size());
      taken_.resize(tree.links.size());
    }
}

template <class S, int Rows, bool Momentum>
template <class In, class Out>
bool LoopSweeps<Spatial, S, Rows, Momentum>::operator()(const S& t, const In& q, const In& x,
                                                        const In& tau, const RightSide<S>& right,
                                                        Out u, Out impulse, Out rate) {
  place_links(
      *tree_, t, q, angles_, joints_,
      users_, [&](std::size_t record) -> auto& { return balls_[record].R; });
  stuck_ = tree_->stuck;
  weak_leg_ = false;
  compliance_ = right.compliance;
  if (stuck_ >= 0) return false;
  for (std::size_t k = 0; k < legs_.size(); ++k)
    if (plan_->takes_legs[k]) legs_[k] = {};
  pose_bodies();
  move_bodies(x, right);
  loops_ = &in_time_.at(value_of(t));
  place_loops(q, x, right);
  if (!inward(Momentum ? x : tau, right)) return false;
  outward(q, right, u, impulse, rate);
  if (Momentum && right.rates) rates_inward(right, impulse, rate);
  return true;
}

/// Points, axes and rows of all loops, d of couplers.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Spatial, S, Rows, Momentum>::place_loops(const In& q, const In& x,
                                                         const RightSide<S>& right) {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    if (l.is_coupler()) {
      coupled_[i] = coupler_bias<Momentum>(*loops_, l, q, x, right);
      continue;
    }
    const LoopBody<S>*A = loop_body(l.a), *B = loop_body(l.b);
    places_[i].place(l, A, B);
    if (l.motion < 0) continue;
    const auto at = static_cast<std::size_t>(l.motion);
    moving_[at].place(l, loops_->motions[at], A, B);
  }
}

/// Poses of the bodies on the ways of loops, in ground axes.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Spatial, S, Rows, Momentum>::pose_bodies() {
  Spatial::Pose<S> ground;
  ground.axes = identity3<S>();
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (!plan_->posed[k]) continue;
    const Link& l = tree_->links[k];
    const auto& from = l.parent < 0 ? ground : bodies_[static_cast<std::size_t>(l.parent)].pose;
    auto& to = bodies_[k].pose;
    if (l.kind == LinkKind::pin) {
      Spatial::Edge<S> e;
      e.cos_theta = angles_.cosine(k);
      e.sin_theta = angles_.sine(k);
      e.d = S(l.d);
      to = Spatial::pose_outward(body(k).edge, JointKind::revolute, e, from);
    } else if (l.kind == LinkKind::ball) {
      const auto record = static_cast<std::size_t>(l.record);
      const auto& r = tree_->balls[record].origin;
      to.axes = from.axes * balls_[record].R;
      to.origin = from.origin + from.axes * Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}};
    } else {
      to = Spatial::pose_outward(body(k).edge, body(k).kind,
                                 joints_[static_cast<std::size_t>(l.record)].edge, from);
    }
  }
}

/// Acceleration form: velocities in ground axes, velocity products and bias wrenches of all bodies.
/// Momentum form: Ω_t of the driven joints.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Spatial, S, Rows, Momentum>::move_bodies(const In& x, const RightSide<S>& right) {
  if constexpr (Momentum) {
    if (joints_.empty()) return;
    for (std::size_t k = 0; k < pins_.size(); ++k) {
      const Link& l = tree_->links[k];
      if (l.kind != LinkKind::general) continue;
      const auto record = static_cast<std::size_t>(l.record);
      any_[record].given = {};
      if (body(k).drive >= 0 && right.drives)
        Joint<Spatial>::add_motion(body(k), joints_[record].edge, &joints_[record].drive_rate,
                                   any_[record].given);
    }
  } else {
    // Ω in body axes, kept where the bodies' wrenches will be.
    const auto velocity = [&](std::size_t k) -> Force& { return wrenches_[k]; };
    for (std::size_t k = 0; k < pins_.size(); ++k) {
      const Link& l = tree_->links[k];
      const auto& b = body(k);
      Motion V{}, own{}, product{};
      Vec3<S> step_product{};
      if (l.parent >= 0) {
        const Force& from = velocity(static_cast<std::size_t>(l.parent));
        V = {from.f, from.n};
      }
      // ω × (ω × r) of the parent's rotation, in the body's axes: cross(ω, velocity it gives O).
      Motion turning{{}, V.w};
      if (l.kind == LinkKind::pin) {
        constants_outward(l, b.edge, V.v[0], V.v[1], V.v[2], V.w[0], V.w[1], V.w[2]);
        constants_outward(l, b.edge, turning.v[0], turning.v[1], turning.v[2], turning.w[0],
                          turning.w[1], turning.w[2]);
        // The pin's screw without its turn: the product is wanted before it.
        V.v[0] = V.v[0] + l.d * V.w[1];
        V.v[1] = V.v[1] - l.d * V.w[0];
        turning.v[0] = turning.v[0] + l.d * turning.w[1];
        turning.v[1] = turning.v[1] - l.d * turning.w[0];
        const S rate = x[l.u];
        step_product = cross(V.w, turning.v);
        pins_[k].c = {step_product, {{V.w[1] * rate, -(V.w[0] * rate), S(0.0)}}};
        pins_[k].c.v[0] += l.d * (V.w[0] * rate);
        pins_[k].c.v[1] += l.d * (V.w[1] * rate);
        const S c = angles_.cosine(k), s = angles_.sine(k);
        momenta::turn_back<2>(V.v, c, s);
        momenta::turn_back<2>(V.w, c, s);
        V.w[2] += rate;
      } else if (l.kind == LinkKind::ball) {
        auto& w = balls_[static_cast<std::size_t>(l.record)];
        const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
        const Vec3<S> step{{S(r[0]), S(r[1]), S(r[2])}};
        const Vec3<S> rate{{x[l.u], x[l.u + 1], x[l.u + 2]}};
        const Vec3<S> way = cross(V.w, step);
        w.c.v = transpose_times(w.R, cross(V.w, way));
        V = {transpose_times(w.R, V.v + way), transpose_times(w.R, V.w)};
        w.c.w = cross(V.w, rate);
        V.w += rate;
      } else {
        auto& j = joints_[static_cast<std::size_t>(l.record)];
        V = Spatial::to_child(b.edge, b.kind, j.edge, V);
        turning = Spatial::to_child(b.edge, b.kind, j.edge, turning);
        S rates[6]{};
        if (b.drive >= 0) {
          Joint<Spatial>::add_motion(b, j.edge, &j.drive_rate, own);
        } else {
          for (int i = 0; i < b.nv; ++i) rates[i] = x[b.u + i];
          Joint<Spatial>::add_motion(b, j.edge, rates, own);
        }
        product = {cross(V.w, turning.v) + cross(S(2.0) * V.w + own.w, own.v), cross(V.w, own.w)};
        if (b.drive >= 0) Joint<Spatial>::add_motion(b, j.edge, &j.drive_acceleration, product);
        any_[static_cast<std::size_t>(l.record)].given = product;
        V += own;
      }
      velocity(k) = {V.v, V.w};
      if (plan_->posed[k]) {
        bodies_[k].v = bodies_[k].pose.axes * V.v;
        bodies_[k].w = bodies_[k].pose.axes * V.w;
      }
    }
  }
}

}  // namespace momenta

#include <momenta/dae/sweeps/spatial_loop_axes.h>
#include <momenta/dae/sweeps/spatial_loop_inward.h>
#include <momenta/dae/sweeps/spatial_loop_joints.h>
#include <momenta/dae/sweeps/spatial_loop_outward.h>
