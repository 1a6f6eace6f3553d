#pragma once
// Closed loops in space inside the two sweeps, as in the plane (planar_loop_sweeps.h), in the
// canonical frames and with the eliminations of the open chain's recursions. For a pin,
//
//   c = C_nz, g = c M_j⁻¹, C' = C − h c, W' = W + c gᵀ, d' = d + g e
//
// and C' takes the same screws to the parent as D'. Momentum form: P* = M'V + D' + C'σ before the
// pin's screw, ṗ = weight − Eᵀ(V × P*) + Eᵀ T*, T* the N − κ w of the loops below, gathered by a
// last sweep over the bodies on their ways. Acceleration form: A = (acceleration of O, dω/dt) in
// body axes, the ground falls upward with −g, c the velocity products of acceleration_sweeps.h.

#include <momenta/core/kernel/pin.h>
#include <momenta/core/kernel/sweeps.h>
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

  int stuck() const { return stuck_; }
  /// Whether the last solution closed a folded leg on too weak a pivot: it is then wrong.
  bool weak_leg() const { return weak_leg_; }
  /// Rows of Φ that faded in the last solution; calls report(row).
  template <class Report>
  void each_faded(Report&& report) const;

 private:
  struct Carried {
    Cargo<S> cargo;
    Blocks blocks;
  };
  struct Moving {
    Motion V;
    Vec3<S> g;      ///< gravity (momentum form)
    Column sigma;
  };
  struct PinRecord {
    Reduced<S> M;   ///< M' after the pin's screw
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

  template <class In>
  void move_bodies(const In& x, const RightSide<S>& right);
  void pose_bodies();
  template <class In>
  bool inward(const In& r, const RightSide<S>& right);
  void enter(std::size_t k, const RightSide<S>& right, Carried& a);
  void enter(std::size_t k, const LoopPlan::End& end, const RightSide<S>& right, Carried& a);
  __attribute__((noinline)) void fold(std::size_t root, const RightSide<S>& right, Carried& leg);
  __attribute__((noinline)) void close(int loop, Carried& a, double fade);
  template <class In>
  bool pin_inward(std::size_t k, const In& r, Carried& a);
  template <class In>
  __attribute__((noinline)) bool ball_inward(std::size_t k, const In& r, Carried& a);
  template <class In>
  __attribute__((noinline)) bool any_inward(std::size_t k, const In& r, Carried& a);
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
  __attribute__((noinline)) void any_outward(std::size_t k, const In& q, bool rates, Moving& m,
                                             Out u, Out rate);
  template <class Out>
  void rates_inward(const RightSide<S>& right, const Out& impulse, Out rate);

  const LinkTree* tree_;
  const LoopModel<Spatial>* loops_;
  const LoopPlan* plan_;
  Angles<S> angles_;
  std::vector<PinRecord> pins_;
  std::vector<BallRecord> balls_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<AnyRecord> any_;
  std::vector<LoopBody<S>> bodies_;
  std::vector<Force> wrenches_;
  std::vector<SpatialLoopPlace<S>> places_;
  std::vector<Carried> slots_;
  std::vector<Moving> outward_slots_;
  std::vector<Row> rows_;
  std::vector<Cargo<S>> legs_;  ///< by body: what folded legs add to it
  std::vector<Motion> taken_;   ///< by body: Ω of those that take legs
  int stuck_ = -1;
  bool weak_leg_ = false;
};

template <class S, int Rows, bool Momentum>
LoopSweeps<Spatial, S, Rows, Momentum>::LoopSweeps(const LinkTree& tree,
                                                   const LoopModel<Spatial>& loops,
                                                   const LoopPlan& plan)
    : tree_(&tree),
      loops_(&loops),
      plan_(&plan),
      angles_(tree.links.size()),
      pins_(tree.links.size()),
      balls_(tree.balls.size()),
      joints_(static_cast<std::size_t>(tree.records)),
      users_(static_cast<std::size_t>(tree.users)),
      any_(static_cast<std::size_t>(tree.records)),
      bodies_(tree.links.size()),
      wrenches_(tree.links.size()),
      places_(loops.loops.size()),
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
      *tree_, t, q, angles_, joints_, users_,
      [&](std::size_t record) -> auto& { return balls_[record].R; });
  stuck_ = tree_->stuck;
  weak_leg_ = false;
  if (stuck_ >= 0) return false;
  for (std::size_t k = 0; k < legs_.size(); ++k)
    if (plan_->takes_legs[k]) legs_[k] = {};
  pose_bodies();
  move_bodies(x, right);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    places_[i].place(l, loop_body(l.a), loop_body(l.b));
  }
  if (!inward(Momentum ? x : tau, right)) return false;
  outward(q, right, u, impulse, rate);
  if (Momentum && right.rates) rates_inward(right, impulse, rate);
  return true;
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
        product = {cross(V.w, turning.v) + cross(S(2.0) * V.w + own.w, own.v),
                   cross(V.w, own.w)};
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

/// The loop ends on body k.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Spatial, S, Rows, Momentum>::enter(std::size_t k, const RightSide<S>& right,
                                                   Carried& a) {
  const LoopPlan::Range range = plan_->ends_of[k];
  for (int i = range.first; i < range.last; ++i)
    enter(k, plan_->ends[static_cast<std::size_t>(i)], right, a);
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Spatial, S, Rows, Momentum>::enter(std::size_t k, const LoopPlan::End& end,
                                                   const RightSide<S>& right, Carried& a) {
  const auto loop = static_cast<std::size_t>(end.loop);
  const Loop& l = loops_->loops[loop];
  const SpatialLoopPlace<S>& s = places_[loop];
  const auto& axes = bodies_[k].pose.axes;
  const int lane = plan_->lane[loop];
  const S sign(end.on_a ? 1.0 : -1.0);
  const Vec3<S> arm = transpose_times(axes, end.on_a ? s.ra : s.rb);
  Vec3<S> centre_force{}, centre_couple{};
  for (int row = 0; row < l.rows; ++row) {
    const Vec3<S> f = transpose_times(axes, sign * s.F[row]);
    const Vec3<S> n = cross(arm, f) + transpose_times(axes, sign * s.c[row]);
    for (int j = 0; j < 3; ++j) {
      a.blocks.C[j].add(lane + row, f[j]);
      a.blocks.C[3 + j].add(lane + row, n[j]);
    }
    if (right.centre) {
      const S centre = right.centre[l.row + row];
      centre_force += centre * f;
      centre_couple += centre * n;
    }
    if (!end.first) continue;
    if (right.positions) a.blocks.d.add(lane + row, s.position(l, row));
    if constexpr (!Momentum) {
      const auto rates = s.rates(loop_body(l.a), loop_body(l.b));
      S d = s.bias(l, rates, row);
      if (right.alpha != 0 || right.beta != 0)
        d += (2 * right.alpha) * s.velocity(rates, row) +
             (right.beta * right.beta) * s.position(l, row);
      // The ground falls upward too: its end of the row accelerates with −g.
      const auto& g = tree_->model->gravity;
      const S along = s.F[row][0] * g[0] + s.F[row][1] * g[1] + s.F[row][2] * g[2];
      if (l.b < 0) d += along;
      if (l.a < 0) d -= along;
      a.blocks.d.add(lane + row, d);
    }
  }
  if (right.centre) {
    a.cargo.Dfx += centre_force[0];
    a.cargo.Dfy += centre_force[1];
    a.cargo.Dfz += centre_force[2];
    a.cargo.Dnx += centre_couple[0];
    a.cargo.Dny += centre_couple[1];
    a.cargo.Dnz += centre_couple[2];
  }
}

/// Closes the loops of a leg that has been eliminated down to the ground into the body they tie it
/// to: r = JᵀΩ_L − W σ + d with the leg's W and d.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Spatial, S, Rows, Momentum>::fold(std::size_t root, const RightSide<S>& right,
                                                  Carried& leg) {
  const auto onto = static_cast<std::size_t>(plan_->folded_onto[root]);
  const LoopPlan::Range range = plan_->ground_closings_of[root];
  leg.cargo = {};
  for (Column& c : leg.blocks.C) c = {};
  for (int i = range.first; i < range.last; ++i) {
    const int loop = plan_->closings[static_cast<std::size_t>(i)];
    const bool on_a = loops_->loops[static_cast<std::size_t>(loop)].a == static_cast<int>(onto);
    enter(onto, {loop, on_a, false}, right, leg);
  }
  for (int i = range.first; i < range.last; ++i) {
    const int loop = plan_->closings[static_cast<std::size_t>(i)];
    close(loop, leg, right.fade);
    const Loop& l = loops_->loops[static_cast<std::size_t>(loop)];
    for (int row = 0; row < l.rows; ++row)
      weak_leg_ |= has_faded(rows_[static_cast<std::size_t>(l.row + row)].kept);
  }
  add<Momentum>(legs_[onto], leg.cargo);
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Spatial, S, Rows, Momentum>::close(int loop, Carried& a, double fade) {
  const Loop& l = loops_->loops[static_cast<std::size_t>(loop)];
  const int points = l.length > 0 ? 1 : l.n_points;
  close_loop(a.blocks, plan_->lane[static_cast<std::size_t>(loop)], points, l.rows - points, fade,
             &rows_[static_cast<std::size_t>(l.row)], SpatialWeight<S, Cargo<S>>{a.cargo});
}

template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Spatial, S, Rows, Momentum>::inward(const In& r, const RightSide<S>& right) {
  const Link* links = tree_->links.data();
  Carried a{}, ground{};
  for (std::size_t k = pins_.size(); k-- > 0;) {
    const Link& l = links[k];
    if (l.tip) a = {};
    add_body(a.cargo.M, l);
    if constexpr (Momentum) {
      a.cargo.Gx = a.cargo.Gx + l.moment[0];
      a.cargo.Gy = a.cargo.Gy + l.moment[1];
      a.cargo.Gz = a.cargo.Gz + l.moment[2];
    } else {
      const Vec3<S>& w = wrenches_[k].n;  // ω × (ω × m c), ω × J ω
      const Vec3<S> mc{{S(l.c[0]), S(l.c[1]), S(l.c[2])}};
      const Vec3<S> Jw{{l.J[0] * w[0] + l.J[1] * w[1] + l.J[2] * w[2],
                        l.J[1] * w[0] + l.J[3] * w[1] + l.J[4] * w[2],
                        l.J[2] * w[0] + l.J[4] * w[1] + l.J[5] * w[2]}};
      const Vec3<S> f = cross(w, cross(w, mc)), n = cross(w, Jw);
      a.cargo.Dfx = a.cargo.Dfx + f[0];
      a.cargo.Dfy = a.cargo.Dfy + f[1];
      a.cargo.Dfz = a.cargo.Dfz + f[2];
      a.cargo.Dnx = a.cargo.Dnx + n[0];
      a.cargo.Dny = a.cargo.Dny + n[1];
      a.cargo.Dnz = a.cargo.Dnz + n[2];
    }
    if (l.slot >= 0) {
      const Carried& slot = slots_[static_cast<std::size_t>(l.slot)];
      add<Momentum>(a.cargo, slot.cargo);
      a.blocks.add(slot.blocks);
    }
    if (plan_->takes_legs[k]) add<Momentum>(a.cargo, legs_[k]);
    enter(k, right, a);
    const LoopPlan::Range closing = plan_->closings_of[k];
    for (int i = closing.first; i < closing.last; ++i)
      close(plan_->closings[static_cast<std::size_t>(i)], a, right.fade);
    if (!(l.kind == LinkKind::pin    ? pin_inward(k, r, a)
          : l.kind == LinkKind::ball ? ball_inward(k, r, a)
                                     : any_inward(k, r, a))) {
      stuck_ = static_cast<int>(k);
      return false;
    }
    if (l.parent < 0 && plan_->folded_onto[k] >= 0) {
      fold(k, right, a);
    } else if (l.parent < 0) {
      ground.blocks.add_at_ground(a.blocks);
      const LoopPlan::Range last = plan_->ground_closings_of[k];
      for (int i = last.first; i < last.last; ++i)
        close(plan_->closings[static_cast<std::size_t>(i)], ground, right.fade);
    } else if (!l.first) {
      Carried& slot = slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      if (l.opens) {
        slot = a;
      } else {
        add<Momentum>(slot.cargo, a.cargo);
        slot.blocks.add(a.blocks);
      }
    }
  }
  return true;
}

template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Spatial, S, Rows, Momentum>::pin_inward(std::size_t k, const In& r, Carried& a) {
  const Link& l = tree_->links[k];
  PinRecord& w = pins_[k];
  Cargo<S>& m = a.cargo;
  Blocks& o = a.blocks;
  if (!all_positive(m.M.Izz)) return false;
  const S inverse = S(1.0) / m.M.Izz, e = S(r[l.u]) - m.Dnz;
  w.y0 = e * inverse;
  Eliminated<S> left;
  eliminate_pin(m.M, inverse, w.h, left.M);
  left.fx = m.Dfx + w.h.fx * e;
  left.fy = m.Dfy + w.h.fy * e;
  left.fz = m.Dfz + w.h.fz * e;
  left.nx = m.Dnx + w.h.nx * e;
  left.ny = m.Dny + w.h.ny * e;
  left.nz = S(r[l.u]);
  left.Gx = w.Gx = m.Gx;
  left.Gy = w.Gy = m.Gy;
  left.Gz = m.Gz;
  // The loops.
  const Column c = o.C[5];
  w.g = c * inverse;
  o.d += c * w.y0;
  o.scale += (o.C[3] * o.C[3] + o.C[4] * o.C[4] + c * c) * inverse;
  for (int i = 0; i < Rows; ++i) o.W[i] += w.g * c[i];
  o.C[0] -= c * w.h.fx;
  o.C[1] -= c * w.h.fy;
  o.C[2] -= c * w.h.fz;
  o.C[3] -= c * w.h.nx;
  o.C[4] -= c * w.h.ny;
  o.C[5] = {};
  // The pin's screw.
  const S cosine = angles_.cosine(k), sine = angles_.sine(k);
  turn_and_shift_z(left.M, cosine, sine, l.d);
  w.M = left.M;
  S x = cosine * left.fx - sine * left.fy;
  left.fy = sine * left.fx + cosine * left.fy;
  left.fx = x;
  x = cosine * left.nx - sine * left.ny;
  left.ny = sine * left.nx + cosine * left.ny + l.d * left.fx;
  left.nx = x - l.d * left.fy;
  x = cosine * left.Gx - sine * left.Gy;
  left.Gy = sine * left.Gx + cosine * left.Gy;
  left.Gx = x;
  screw_columns<2>(o.C, cosine, sine, S(l.d));
  if constexpr (Momentum) {
    w.Dfx = left.fx;
    w.Dfy = left.fy;
    w.Dnx = left.nx;
    w.Dny = left.ny;
    w.C[0] = o.C[0];
    w.C[1] = o.C[1];
    w.C[2] = o.C[3];
    w.C[3] = o.C[4];
    if (l.parent < 0) return true;
  } else {
    // D' += M'c, d' += C'ᵀc; on the ground c is its fall.
    if (l.parent < 0) {
      const Vec3<double>& g = tree_->weight[k];
      w.c = {{{S(-g[0]), S(-g[1]), S(-g[2])}}, {}};
    }
    const Reduced<S>& M = left.M;
    const Vec3<S>&v = w.c.v, &n = w.c.w;
    left.fx += M.Axx * v[0] + M.Axy * v[1] + M.Axz * v[2] + M.Hxx * n[0] + M.Hxy * n[1];
    left.fy += M.Axy * v[0] + M.Ayy * v[1] + M.Ayz * v[2] + M.Hyx * n[0] + M.Hyy * n[1];
    left.fz += M.Axz * v[0] + M.Ayz * v[1] + M.Azz * v[2] + M.Hzx * n[0] + M.Hzy * n[1];
    left.nx += M.Hxx * v[0] + M.Hyx * v[1] + M.Hzx * v[2] + M.Ixx * n[0] + M.Ixy * n[1];
    left.ny += M.Hxy * v[0] + M.Hyy * v[1] + M.Hzy * v[2] + M.Ixy * n[0] + M.Iyy * n[1];
    o.d += o.C[0] * v[0] + o.C[1] * v[1] + o.C[2] * v[2] + o.C[3] * n[0] + o.C[4] * n[1];
    if (l.parent < 0) return true;
  }
  carry_any<Momentum>(l, body(k).edge, left, m);
  columns_to_parent<S>(body(k).edge, o.C);
  return true;
}

template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Spatial, S, Rows, Momentum>::ball_inward(std::size_t k, const In& r, Carried& a) {
  const Link& l = tree_->links[k];
  const auto record = static_cast<std::size_t>(l.record);
  BallRecord& w = balls_[record];
  Cargo<S>& m = a.cargo;
  Blocks& o = a.blocks;
  w.p = {{S(r[l.u]), S(r[l.u + 1]), S(r[l.u + 2])}};
  if (!w.pivot.eliminate(m.M, w.A)) return false;
  w.G = {{m.Gx, m.Gy, m.Gz}};
  w.Df = Vec3<S>{{m.Dfx, m.Dfy, m.Dfz}} +
         w.pivot.remainder(w.p - Vec3<S>{{m.Dnx, m.Dny, m.Dnz}});
  // L⁻¹ c, then as three pins.
  Column z[3];
  z[0] = o.C[3];
  z[1] = o.C[4] - z[0] * w.pivot.l10;
  z[2] = o.C[5] - z[0] * w.pivot.l20 - z[1] * w.pivot.l21;
  const S inverse[3] = {w.pivot.i0, w.pivot.i1, w.pivot.i2};
  for (int i = 0; i < 3; ++i) {
    w.g[i] = z[i] * inverse[i];
    o.d += w.g[i] * w.pivot.e[i];
    o.scale += z[i] * w.g[i];
    for (int j = 0; j < Rows; ++j) o.W[j] += w.g[i] * z[i][j];
    for (int j = 0; j < 3; ++j) o.C[j] -= z[i] * w.pivot.s(j, i);
    o.C[3 + i] = {};
  }
  for (int i = 0; i < 3; ++i) w.C[i] = o.C[i];
  Vec3<S> force = w.Df;
  if constexpr (!Momentum) {
    if (l.parent < 0) {
      const auto& g = tree_->model->gravity;
      w.c.v = transpose_times(w.R, Vec3<S>{{S(-g[0]), S(-g[1]), S(-g[2])}});
    }
    force += w.A * w.c.v;
    o.d += o.C[0] * w.c.v[0] + o.C[1] * w.c.v[1] + o.C[2] * w.c.v[2];
  }
  if (l.parent < 0) return true;
  const auto& at = tree_->balls[record].origin;
  carry_ball(at, w.R, w.A, force, w.p, m);
  if constexpr (Momentum) {
    const Vec3<S> G = w.R * w.G;
    m.Gx = G[0];
    m.Gy = G[1];
    m.Gz = G[2];
  }
  columns_to_parent(w.R, Vec3<S>{{S(at[0]), S(at[1]), S(at[2])}}, o.C);
  return true;
}

/// Sliders, screws, free, driven and welded joints.
template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Spatial, S, Rows, Momentum>::any_inward(std::size_t k, const In& r, Carried& a) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  auto& y = any_[static_cast<std::size_t>(l.record)];
  Blocks& o = a.blocks;
  x.M = blocks(a.cargo.M);
  x.D = remainder_of(a.cargo);
  x.moment = {{a.cargo.Gx, a.cargo.Gy, a.cargo.Gz}};
  for (int i = 0; i < 6; ++i) y.C[i] = o.C[i];
  S right[6]{};
  for (int i = 0; i < b.nv; ++i) right[i] = S(r[b.u + i]);
  Spatial::ArticulatedInertia<S> M;
  if (!eliminate<Spatial>(b, x, M)) return false;
  auto D = remainder<Spatial>(b, x, right);
  const auto eliminate_lanes = [&](const Column& c, const Column& g, const S& e) {
    o.d += g * e;
    o.scale += c * g;
    for (int i = 0; i < Rows; ++i) o.W[i] += g * c[i];
  };
  if (b.nv == 1) {
    Motion E{};
    const S one(1.0);
    Joint<Spatial>::add_motion(b, x.edge, &one, E);
    Column c = o.C[0] * E[0];
    for (int i = 1; i < 6; ++i) c += o.C[i] * E[i];
    y.g[0] = c * x.pivot;
    eliminate_lanes(c, y.g[0], x.e);
    for (int i = 0; i < 6; ++i) o.C[i] -= c * x.h[i];
  } else if (b.nv == 6) {
    // Angular: I⁻¹ c_n; then A⁻¹ (c_f − H I⁻¹ c_n).
    Column left[3];
    for (int i = 0; i < 3; ++i) {
      y.g[3 + i] = o.C[3] * x.I(i, 0) + o.C[4] * x.I(i, 1) + o.C[5] * x.I(i, 2);
      left[i] = o.C[i] - (o.C[3] * x.H(i, 0) + o.C[4] * x.H(i, 1) + o.C[5] * x.H(i, 2));
    }
    for (int i = 0; i < 3; ++i)
      eliminate_lanes(o.C[3 + i], y.g[3 + i], right[3 + i] - x.D.n[i]);
    for (int i = 0; i < 3; ++i)
      y.g[i] = left[0] * x.A(i, 0) + left[1] * x.A(i, 1) + left[2] * x.A(i, 2);
    for (int i = 0; i < 3; ++i) eliminate_lanes(left[i], y.g[i], x.y[i]);
    for (int i = 0; i < 6; ++i) o.C[i] = {};
  }
  if constexpr (!Momentum)
    if (b.parent < 0) {
      const auto& g = tree_->model->gravity;
      y.given.v -= Spatial::direction_to_child(b.edge, b.kind, x.edge,
                                               Vec3<S>{{S(g[0]), S(g[1]), S(g[2])}});
    }
  if (b.nv != 6) {  // else nothing is left: M' = 0, C' = 0
    D += Spatial::momentum(M, y.given);
    for (int i = 0; i < 6; ++i) o.d += o.C[i] * y.given[i];
  }
  if (b.parent < 0) return true;
  Vec3<S> G{};
  if constexpr (Momentum)
    G = Spatial::moment_to_parent(b.edge, b.kind, x.edge, x.moment, b.subtree_mass);
  set_cargo(a.cargo, Spatial::to_parent(b.edge, b.kind, x.edge, M),
            Spatial::to_parent(b.edge, b.kind, x.edge, D), G);
  if (Spatial::moves_freely(b.kind))
    columns_to_parent(x.edge.rotation, x.edge.position, o.C);
  else
    screw_columns<2>(o.C, x.edge.cos_theta, x.edge.sin_theta, x.edge.d);
  columns_to_parent<S>(b.edge, o.C);
  return true;
}

/// Impulses of the loops in `range`, last closed first; `motion` null at the ground.
template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Spatial, S, Rows, Momentum>::solve_loops(const LoopPlan::Range& range,
                                                         const RightSide<S>& right,
                                                         const Motion* motion, Column& sigma,
                                                         Out& out) {
  for (int i = range.last; i-- > range.first;) {
    const auto at = static_cast<std::size_t>(plan_->closings[static_cast<std::size_t>(i)]);
    const Loop& l = loops_->loops[at];
    for (int j = l.rows; j-- > 0;) {
      const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
      const S x = motion ? row.impulse(*motion, sigma) : row.impulse_at_ground(sigma);
      sigma.set(row.lane, x);
      const int place = l.row + row.lane - plan_->lane[at];
      out[place] = right.centre ? x + right.centre[place] : x;
    }
  }
}

template <class S, int Rows, bool Momentum>
template <class In, class Out>
void LoopSweeps<Spatial, S, Rows, Momentum>::outward(const In& q, const RightSide<S>& right, Out u,
                                                     Out impulse, Out rate) {
  const Link* links = tree_->links.data();
  const bool rates = Momentum && right.rates;
  const auto& gravity = tree_->model->gravity;
  Moving m{};
  Column at_ground{};
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const Link& l = links[k];
    if (l.parent < 0) {
      m.V = {};
      for (int i = 0; i < 3; ++i) m.g[i] = S(gravity[i]);
      if (const int onto = plan_->folded_onto[k]; onto >= 0) {
        m.sigma = {};
        solve_loops(plan_->ground_closings_of[k], right, &taken_[static_cast<std::size_t>(onto)],
                    m.sigma, impulse);
      } else {
        solve_loops(plan_->ground_closings_of[k], right, nullptr, at_ground, impulse);
        m.sigma = at_ground;
      }
    } else if (!l.first) {
      m = outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
    }
    if (l.kind == LinkKind::pin)
      pin_outward(k, q, rates, m, u, rate);
    else if (l.kind == LinkKind::ball)
      ball_outward(k, rates, m, u, rate);
    else
      any_outward(k, q, rates, m, u, rate);
    const LoopPlan::Range closed = plan_->closings_of[k];
    if (closed.first != closed.last) solve_loops(closed, right, &m.V, m.sigma, impulse);
    if (plan_->takes_legs[k]) taken_[k] = m.V;
    if constexpr (Momentum)
      if (rates && plan_->posed[k]) {
        bodies_[k].v = bodies_[k].pose.axes * m.V.v;
        bodies_[k].w = bodies_[k].pose.axes * m.V.w;
      }
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = m;
  }
}

template <class S, int Rows, bool Momentum>
template <class In, class Out>
void LoopSweeps<Spatial, S, Rows, Momentum>::pin_outward(std::size_t k, const In& q, bool rates,
                                                         Moving& m, Out u, Out rate) {
  const Link& l = tree_->links[k];
  const PinRecord& w = pins_[k];
  Vec3<S>&v = m.V.v, &o = m.V.w;
  const S c = angles_.cosine(k), s = angles_.sine(k);
  S turned(0.0);
  const bool falls = Momentum && rates && tree_->model->has_gravity;
  if (l.parent >= 0) {
    constants_outward(l, body(k).edge, v[0], v[1], v[2], o[0], o[1], o[2]);
    if constexpr (!Momentum) m.V += w.c;
    if (falls) constants_outward(l, body(k).edge, m.g[0], m.g[1], m.g[2]);
    if (rates) {
      const Reduced<S>& M = w.M;
      const S Pfx = M.Axx * v[0] + M.Axy * v[1] + M.Axz * v[2] + M.Hxx * o[0] + M.Hxy * o[1] +
                    w.Dfx + dot(w.C[0], m.sigma);
      const S Pfy = M.Axy * v[0] + M.Ayy * v[1] + M.Ayz * v[2] + M.Hyx * o[0] + M.Hyy * o[1] +
                    w.Dfy + dot(w.C[1], m.sigma);
      const S Pnx = M.Hxx * v[0] + M.Hyx * v[1] + M.Hzx * v[2] + M.Ixx * o[0] + M.Ixy * o[1] +
                    w.Dnx + dot(w.C[2], m.sigma);
      const S Pny = M.Hxy * v[0] + M.Hyy * v[1] + M.Hzy * v[2] + M.Ixy * o[0] + M.Iyy * o[1] +
                    w.Dny + dot(w.C[3], m.sigma);
      turned = v[1] * Pfx - v[0] * Pfy + o[1] * Pnx - o[0] * Pny;
    }
    v[0] = v[0] + l.d * o[1];
    v[1] = v[1] - l.d * o[0];
  } else {
    m.V = {};
    if constexpr (!Momentum) m.V = w.c;
    if (falls) {
      const Vec3<double>& g = tree_->weight[k];
      m.g = {{S(g[0]), S(g[1]), S(g[2])}};
    }
  }
  momenta::turn_back<2>(v, c, s);
  momenta::turn_back<2>(o, c, s);
  if (falls) {
    momenta::turn_back<2>(m.g, c, s);
    turned = turned + (w.Gx * m.g[1] - w.Gy * m.g[0]);
  }
  const S turning = w.y0 - dot(w.g, m.sigma) -
                    (w.h.fx * v[0] + w.h.fy * v[1] + w.h.fz * v[2] + w.h.nx * o[0] + w.h.ny * o[1]);
  const S own = turning - o[2];
  o[2] = turning;
  u[l.u] = own;
  if (rates) rate[l.u] = l.has_force ? turned + joint_force(body(k), S(q[l.q]), own) : turned;
}

template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Spatial, S, Rows, Momentum>::ball_outward(std::size_t k, bool rates, Moving& m,
                                                          Out u, Out rate) {
  const Link& l = tree_->links[k];
  const BallRecord& w = balls_[static_cast<std::size_t>(l.record)];
  Vec3<S>&v = m.V.v, &o = m.V.w;
  if (l.parent >= 0) {
    const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
    v = transpose_times(w.R, v + cross(o, Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}}));
    o = transpose_times(w.R, o);
  }
  if constexpr (!Momentum) m.V += w.c;
  m.g = transpose_times(w.R, m.g);
  // ω = L⁻ᵀ (Δ⁻¹ L⁻¹ e − (Z Δ⁻¹)ᵀ v − g σ)
  const Vec3<S> along = transpose_times(w.pivot.s, v);
  const S z = w.pivot.e[2] * w.pivot.i2 - along[2] - dot(w.g[2], m.sigma);
  const S y = w.pivot.e[1] * w.pivot.i1 - along[1] - dot(w.g[1], m.sigma) - w.pivot.l21 * z;
  const Vec3<S> omega{{w.pivot.e[0] * w.pivot.i0 - along[0] - dot(w.g[0], m.sigma) -
                           w.pivot.l10 * y - w.pivot.l20 * z,
                       y, z}};
  Vec3<S> net{};
  if (rates) {
    Vec3<S> P = w.A * v + w.Df;
    for (int i = 0; i < 3; ++i) P[i] += dot(w.C[i], m.sigma);
    net = cross(w.G, m.g) - cross(v, P) - cross(omega, w.p);
  }
  for (int i = 0; i < 3; ++i) {
    u[l.u + i] = omega[i] - o[i];
    if (rates) rate[l.u + i] = net[i];
  }
  o = omega;
}

template <class S, int Rows, bool Momentum>
template <class In, class Out>
void LoopSweeps<Spatial, S, Rows, Momentum>::any_outward(std::size_t k, const In& q, bool rates,
                                                         Moving& m, Out u, Out rate) {
  const auto& b = body(k);
  const auto record = static_cast<std::size_t>(tree_->links[k].record);
  const auto& x = joints_[record];
  const auto& y = any_[record];
  if (b.parent >= 0) m.V = Spatial::to_child(b.edge, b.kind, x.edge, m.V);
  m.g = Spatial::direction_to_child(b.edge, b.kind, x.edge, m.g);
  m.V += y.given;
  S own[6];
  if (b.nv == 1) {
    own[0] = x.pivot * x.e - Spatial::power(x.h, m.V) - dot(y.g[0], m.sigma);
    Joint<Spatial>::add_motion(b, x.edge, own, m.V);
  } else if (b.nv == 6) {
    Vec3<S> v = x.A * x.y;
    for (int i = 0; i < 3; ++i) v[i] -= dot(y.g[i], m.sigma);
    Vec3<S> omega = x.x - transpose_times(x.H, v);
    for (int i = 0; i < 3; ++i) omega[i] -= dot(y.g[3 + i], m.sigma);
    for (int i = 0; i < 3; ++i) {
      own[i] = v[i] - m.V.v[i];
      own[3 + i] = omega[i] - m.V.w[i];
    }
    m.V = {v, omega};
  }
  if (b.nv == 0) return;
  for (int i = 0; i < b.nv; ++i) u[b.u + i] = own[i];
  if (!rates) return;
  Force net = Spatial::weight(S(b.subtree_mass), x.moment, m.g);
  Force P = Spatial::momentum(x.M, m.V);  // (42)
  P += x.D;
  for (int i = 0; i < 6; ++i) P[i] += dot(y.C[i], m.sigma);
  net -= Spatial::cross_force(m.V, P);
  S along[6];
  Joint<Spatial>::project(b, x.edge, net, along);  // (35)
  if (b.nv == 1 && tree_->model->has_joint_forces) along[0] += joint_force(b, S(q[b.q]), own[0]);
  for (int i = 0; i < b.nv; ++i) rate[b.u + i] = along[i];
}

template <class S, int Rows, bool Momentum>
typename LoopSweeps<Spatial, S, Rows, Momentum>::Force
LoopSweeps<Spatial, S, Rows, Momentum>::wrench_to_parent(std::size_t k, Force f) const {
  const Link& l = tree_->links[k];
  if (l.kind == LinkKind::ball) {
    const auto record = static_cast<std::size_t>(l.record);
    const auto& r = tree_->balls[record].origin;
    const Mat3<S>& R = balls_[record].R;
    const Vec3<S> force = R * f.f;
    return {force, R * f.n + cross(Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}}, force)};
  }
  if (l.kind == LinkKind::general)
    return Spatial::to_parent(body(k).edge, body(k).kind,
                              joints_[static_cast<std::size_t>(l.record)].edge, f);
  Spatial::Edge<S> e;
  e.cos_theta = angles_.cosine(k);
  e.sin_theta = angles_.sine(k);
  e.d = S(l.d);
  return Spatial::to_parent(body(k).edge, JointKind::revolute, e, f);
}

/// ṗ += Eᵀ T*: N − κ w of the loops below.
template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Spatial, S, Rows, Momentum>::rates_inward(const RightSide<S>& right,
                                                          const Out& impulse, Out rate) {
  for (std::size_t k = 0; k < wrenches_.size(); ++k)
    if (plan_->posed[k]) wrenches_[k] = {};
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    const SpatialLoopPlace<S>& s = places_[i];
    Vec3<S> force, couple;
    s.inertial_rate(
        l, s.rates(loop_body(l.a), loop_body(l.b)),
        [&](int row) { return S(impulse[l.row + row]); }, right.leak, force, couple);
    const auto act = [&](int on, const Vec3<S>& arm, const S& sign) {
      if (on < 0) return;
      const auto k = static_cast<std::size_t>(on);
      const auto& axes = bodies_[k].pose.axes;
      const Vec3<S> n = couple + cross(arm, force);
      wrenches_[k] += Force{transpose_times(axes, sign * force), transpose_times(axes, sign * n)};
    };
    act(l.a, s.ra, S(1.0));
    act(l.b, s.rb, S(-1.0));
  }
  for (std::size_t k = wrenches_.size(); k-- > 0;) {
    if (!plan_->posed[k]) continue;
    const Link& l = tree_->links[k];
    const auto& b = body(k);
    const Force& T = wrenches_[k];
    if (l.kind == LinkKind::pin) {
      rate[l.u] = S(rate[l.u]) + T.n[2];
    } else if (l.kind == LinkKind::ball) {
      for (int i = 0; i < 3; ++i) rate[l.u + i] = S(rate[l.u + i]) + T.n[i];
    } else if (b.nv > 0) {
      S along[6];
      Joint<Spatial>::project(b, joints_[static_cast<std::size_t>(l.record)].edge, T, along);
      for (int i = 0; i < b.nv; ++i) rate[b.u + i] = S(rate[b.u + i]) + along[i];
    }
    if (l.parent >= 0) wrenches_[static_cast<std::size_t>(l.parent)] += wrench_to_parent(k, T);
  }
}

template <class S, int Rows, bool Momentum>
template <class Report>
void LoopSweeps<Spatial, S, Rows, Momentum>::each_faded(Report&& report) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    for (int j = 0; j < l.rows; ++j) {
      const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
      if (has_faded(row.kept)) report(l.row + row.lane - plan_->lane[i]);
    }
  }
}

}  // namespace momenta
