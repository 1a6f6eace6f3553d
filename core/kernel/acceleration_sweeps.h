#pragma once
// The articulated-body recursion (Featherstone) in space, (q, u, t) → u̇, in the frames and with
// every trick of the momentum recursion: its twin, and the opponent it is measured against.
//
//   outward   Ω of every body; c: what its acceleration has beside 𝒯ⱽ A_L and E u̇; bias wrench
//             b = (ω × (ω × m c), ω × J ω)
//   inward    M* as in the momentum recursion; e = τ − Eᵀ D, D_L += 𝒯ᶠ (D + h e + M' c)
//   outward   W = 𝒯ⱽ A_L + c, u̇ = M_j⁻¹ e − hᵀ W, A = W + E u̇
//
// A = (acceleration of O, dω/dt) in body axes. With the acceleration of the point O itself instead
// of the derivative of v in body axes, linear velocities drop out: only ω runs outward. Gravity is
// an acceleration −g of the ground. For a pin with the way (x screw, z screw) from its parent,
//   c = R ω × (ω × r) + the joint's part,  α part of c = ω × z q̇ = (ω_y q̇, −ω_x q̇, 0).

#include <momenta/core/kernel/pin.h>

namespace momenta {

template <class S>
struct PinAcceleration {
  PinColumn<S> h;
  S y0;                            ///< M_j⁻¹ e
  S bfx, bfy, bfz, bnx, bny, bnz;  ///< bias wrench
  S clx, cly, clz, cox, coy;       ///< c, in the frame before the pin's screw
};
template <class S>
struct BallAcceleration {
  Mat3<S> R;
  BallPivot<S> pivot;
  Vec3<S> bf, bn, cl, co;
};

template <class Space, class S>
class AccelerationSweeps;

template <class S>
class AccelerationSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit AccelerationSweeps(const LinkTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        pins_(tree.links.size()),
        balls_(tree.balls.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        users_(static_cast<std::size_t>(tree.users)),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(static_cast<std::size_t>(tree.slots)) {}

  /// u̇ (nv) from (q, u, t) and all generalised forces τ (nv) but the weights'. In and Out index
  /// like pointers to S. False when a joint's articulated inertia is not positive: stuck().
  /// O(bodies).
  template <class In, class InTau, class Out>
  bool operator()(const S& t, const In& q, const In& u, const InTau& tau, Out udot) {
    place_links(
        *tree_, t, q, angles_, joints_,
        users_, [&](std::size_t record) -> auto& { return balls_[record].R; });
    stuck_ = tree_->stuck;
    if (stuck_ >= 0) return false;
    velocities(u);
    if (!inward(tau)) return false;
    outward(udot);
    return true;
  }

  int stuck() const { return stuck_; }

 private:
  template <class In>
  void velocities(const In& u);
  template <class InTau>
  bool inward(const InTau& tau);
  template <class Out>
  void outward(Out udot);

  template <Turn turn, class InTau>
  __attribute__((noinline)) std::size_t chain_inward(std::size_t end, const InTau& tau,
                                                     Cargo<S>& cargo);
  template <class InTau>
  __attribute__((noinline)) bool pin_inward(std::size_t k, const InTau& tau, Cargo<S>& cargo);
  template <class InTau>
  __attribute__((noinline)) bool ball_inward(std::size_t k, const InTau& tau, Cargo<S>& cargo);
  template <class InTau>
  __attribute__((noinline)) bool general_inward(std::size_t k, const InTau& tau, Cargo<S>& cargo);
  template <class In>
  __attribute__((noinline)) void any_velocity(std::size_t k, const In& u, OutwardCargo<S>& cargo);
  template <class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, Out udot, OutwardCargo<S>& cargo);
  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  Cargo<S>& slot_of_parent(const Link& l) {
    return slots_[static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }

  const LinkTree* tree_;
  Angles<S> angles_;
  std::vector<PinAcceleration<S>> pins_;
  std::vector<BallAcceleration<S>> balls_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<Cargo<S>> slots_;
  std::vector<OutwardCargo<S>> outward_slots_;
  int stuck_ = -1;
};

/// ω × (ω × m c) and ω × J ω of a body.
template <class S>
MOMENTA_INLINE void bias_wrench(const Link& l, const S& ox, const S& oy, const S& oz, S& bfx,
                                S& bfy, S& bfz, S& bnx, S& bny, S& bnz) {
  const S kx = oy * l.c[2] - oz * l.c[1];
  const S ky = oz * l.c[0] - ox * l.c[2];
  const S kz = ox * l.c[1] - oy * l.c[0];
  bfx = oy * kz - oz * ky;
  bfy = oz * kx - ox * kz;
  bfz = ox * ky - oy * kx;
  const S lx = l.J[0] * ox + l.J[1] * oy + l.J[2] * oz;
  const S ly = l.J[1] * ox + l.J[3] * oy + l.J[4] * oz;
  const S lz = l.J[2] * ox + l.J[4] * oy + l.J[5] * oz;
  bnx = oy * lz - oz * ly;
  bny = oz * lx - ox * lz;
  bnz = ox * ly - oy * lx;
}

template <class S>
template <class In>
void AccelerationSweeps<Spatial, S>::velocities(const In& u) {
  const Link* links = tree_->links.data();
  const S zero(0.0);
  S ox = zero, oy = zero, oz = zero, x;
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Link& l = links[k];
    if (l.parent >= 0 && !l.first) {
      const auto& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
    }
    if (l.kind != LinkKind::pin || l.screwed || l.turn == Turn::tilted) {
      OutwardCargo<S> here{zero, zero, zero, ox, oy, oz, zero, zero, zero};
      any_velocity(k, u, here);
      ox = here.ox;
      oy = here.oy;
      oz = here.oz;
    } else {
      PinAcceleration<S>& w = pins_[k];
      const S own = u[l.u];
      if (l.parent < 0) {
        ox = oy = zero;
        oz = own;
      } else {
        const S yy = oy * oy, zz = oz * oz;
        S px = -(l.a * (yy + zz)), py = l.a * (ox * oy), pz = l.a * (ox * oz);
        constants_outward(l, body(k).edge, ox, oy, oz);
        constants_outward(l, body(k).edge, px, py, pz);
        const S wz = oz + own, dx = l.d * ox, dy = l.d * oy;
        w.clx = px + dx * wz;
        w.cly = py + dy * wz;
        w.clz = pz - (dx * ox + dy * oy);
        w.cox = oy * own;
        w.coy = -(ox * own);
        const S c = angles_.cosine(k), s = angles_.sine(k);
        x = c * ox + s * oy;
        oy = c * oy - s * ox;
        ox = x;
        oz = wz;
      }
      bias_wrench(l, ox, oy, oz, w.bfx, w.bfy, w.bfz, w.bnx, w.bny, w.bnz);
    }
    if (l.slot >= 0) {
      auto& to = outward_slots_[static_cast<std::size_t>(l.slot)];
      to.ox = ox;
      to.oy = oy;
      to.oz = oz;
    }
  }
}

template <class S>
template <class In>
void AccelerationSweeps<Spatial, S>::any_velocity(std::size_t k, const In& u,
                                                  OutwardCargo<S>& cargo) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  // The parent's rotation seen from the child: ω, and the velocity ω × r it gives the child's
  // origin.
  Spatial::Motion<S> W{{}, {{cargo.ox, cargo.oy, cargo.oz}}};
  if (l.parent < 0) W = {};
  Vec3<S> omega;
  if (l.kind == LinkKind::pin) {
    auto& w = pins_[k];
    if (l.parent >= 0) {  // in the frame before the pin's screw
      const Spatial::Edge<S> constant;
      W = Spatial::to_child(b.edge, JointKind::weld, constant, W);
      const Vec3<S> p = cross(W.w, W.v);
      const S own = u[l.u], wz = W.w[2] + own, dx = l.d * W.w[0], dy = l.d * W.w[1];
      w.clx = p[0] + dx * wz;
      w.cly = p[1] + dy * wz;
      w.clz = p[2] - (dx * W.w[0] + dy * W.w[1]);
      w.cox = W.w[1] * own;
      w.coy = -(W.w[0] * own);
      momenta::turn_back<2>(W.w, angles_.cosine(k), angles_.sine(k));
    }
    omega = W.w;
    omega[2] += u[l.u];
    bias_wrench(l, omega[0], omega[1], omega[2], w.bfx, w.bfy, w.bfz, w.bnx, w.bny, w.bnz);
  } else if (l.kind == LinkKind::ball) {
    auto& w = balls_[static_cast<std::size_t>(l.record)];
    const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
    const Vec3<S> step{{S(r[0]), S(r[1]), S(r[2])}}, own{{u[l.u], u[l.u + 1], u[l.u + 2]}};
    w.cl = transpose_times(w.R, cross(W.w, cross(W.w, step)));
    const Vec3<S> before = transpose_times(w.R, W.w);
    w.co = cross(before, own);
    omega = before + own;
    bias_wrench(l, omega[0], omega[1], omega[2], w.bf[0], w.bf[1], w.bf[2], w.bn[0], w.bn[1],
                w.bn[2]);
  } else {
    auto& w = joints_[static_cast<std::size_t>(l.record)];
    if (l.parent >= 0) W = Spatial::to_child(b.edge, b.kind, w.edge, W);
    Spatial::Motion<S> own{};
    S rates[6]{};
    if (b.drive >= 0) {
      Joint<Spatial>::add_motion(b, w.edge, &w.drive_rate, own);
    } else {
      for (int i = 0; i < b.nv; ++i) rates[i] = u[b.u + i];
      Joint<Spatial>::add_motion(b, w.edge, rates, own);
      if (b.law) {
        own += w.user->motion.drift;
        Joint<Spatial>::move(b, w.edge, static_cast<const S*>(rates));
      }
    }
    omega = W.w + own.w;
    w.c = {cross(W.w, W.v) + cross(W.w + omega, own.v), cross(W.w, own.w)};
    if (b.drive >= 0) Joint<Spatial>::add_motion(b, w.edge, &w.drive_acceleration, w.c);
    if (b.law) Joint<Spatial>::add_motion_rate(b, w.edge, static_cast<const S*>(rates), w.c);
    w.D = {};
    bias_wrench(l, omega[0], omega[1], omega[2], w.D.f[0], w.D.f[1], w.D.f[2], w.D.n[0], w.D.n[1],
                w.D.n[2]);
  }
  cargo.ox = omega[0];
  cargo.oy = omega[1];
  cargo.oz = omega[2];
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::inward(const InTau& tau) {
  const Link* links = tree_->links.data();
  Cargo<S> cargo{};
  for (std::size_t k = angles_.size(); k > 0;) {
    switch (links[k - 1].path) {
      case Path::chain_general:
        k = chain_inward<Turn::general>(k, tau, cargo);
        break;
      case Path::chain_right:
        k = chain_inward<Turn::right>(k, tau, cargo);
        break;
      case Path::chain_parallel:
        k = chain_inward<Turn::parallel>(k, tau, cargo);
        break;
      case Path::any:
        --k;
        if (!(links[k].kind == LinkKind::pin    ? pin_inward(k, tau, cargo)
              : links[k].kind == LinkKind::ball ? ball_inward(k, tau, cargo)
                                                : general_inward(k, tau, cargo)))
          stuck_ = static_cast<int>(k);
        break;
    }
    if (stuck_ >= 0) return false;
  }
  return true;
}

/// + the body's bias wrench.
template <class S>
MOMENTA_INLINE void add_bias(Cargo<S>& cargo, const PinAcceleration<S>& w) {
  cargo.Dfx = cargo.Dfx + w.bfx;
  cargo.Dfy = cargo.Dfy + w.bfy;
  cargo.Dfz = cargo.Dfz + w.bfz;
  cargo.Dnx = cargo.Dnx + w.bnx;
  cargo.Dny = cargo.Dny + w.bny;
  cargo.Dnz = cargo.Dnz + w.bnz;
}
/// D' after the pin is eliminated.
template <class S>
MOMENTA_INLINE void eliminate_bias(const Cargo<S>& cargo, const S& tau, const S& inverse,
                                   PinAcceleration<S>& w, Eliminated<S>& r) {
  const S e = tau - cargo.Dnz;
  w.y0 = e * inverse;
  r.fx = cargo.Dfx + w.h.fx * e;
  r.fy = cargo.Dfy + w.h.fy * e;
  r.fz = cargo.Dfz + w.h.fz * e;
  r.nx = cargo.Dnx + w.h.nx * e;
  r.ny = cargo.Dny + w.h.ny * e;
  r.nz = tau;
}
/// The pin's screw for M' and D', then D' += M' c.
template <class S>
MOMENTA_INLINE void turn_pin(Eliminated<S>& r, const S& c, const S& s, double d,
                             const PinAcceleration<S>& w) {
  turn_and_shift_z(r.M, c, s, d);
  S x = c * r.fx - s * r.fy;
  r.fy = s * r.fx + c * r.fy;
  r.fx = x;
  x = c * r.nx - s * r.ny;
  r.ny = s * r.nx + c * r.ny;
  r.nx = x - d * r.fy;
  r.ny = r.ny + d * r.fx;
  const Reduced<S>& m = r.M;
  r.fx = r.fx + (m.Axx * w.clx + m.Axy * w.cly + m.Axz * w.clz + m.Hxx * w.cox + m.Hxy * w.coy);
  r.fy = r.fy + (m.Axy * w.clx + m.Ayy * w.cly + m.Ayz * w.clz + m.Hyx * w.cox + m.Hyy * w.coy);
  r.fz = r.fz + (m.Axz * w.clx + m.Ayz * w.cly + m.Azz * w.clz + m.Hzx * w.cox + m.Hzy * w.coy);
  r.nx = r.nx + (m.Hxx * w.clx + m.Hyx * w.cly + m.Hzx * w.clz + m.Ixx * w.cox + m.Ixy * w.coy);
  r.ny = r.ny + (m.Hxy * w.clx + m.Hyy * w.cly + m.Hzy * w.clz + m.Ixy * w.cox + m.Iyy * w.coy);
}

template <class S>
template <Turn turn, class InTau>
std::size_t AccelerationSweeps<Spatial, S>::chain_inward(std::size_t end, const InTau& tau,
                                                         Cargo<S>& from) {
  Cargo<S> cargo = from;
  const Link* links = tree_->links.data();
  std::size_t k = end;
  do {
    --k;
    const Link& l = links[k];
    PinAcceleration<S>& w = pins_[k];
    add_body(cargo.M, l);
    add_bias(cargo, w);
    if (!all_positive(cargo.M.Izz)) {
      stuck_ = static_cast<int>(k);
      return k;
    }
    Eliminated<S> r;
    const S inverse = S(1.0) / cargo.M.Izz;
    PinColumn<S> h;
    eliminate_pin(cargo.M, inverse, h, r.M);
    w.h = h;
    eliminate_bias(cargo, S(tau[l.u]), inverse, w, r);
    turn_pin(r, angles_.cosine(k), angles_.sine(k), l.d, w);
    carry<turn, false>(r, l, cargo);
  } while (links[k - 1].path == static_cast<Path>(turn));
  from = cargo;
  return k;
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::pin_inward(std::size_t k, const InTau& tau, Cargo<S>& cargo) {
  const Link& l = tree_->links[k];
  PinAcceleration<S>& w = pins_[k];
  Eliminated<S> r;
  S inverse;
  if (l.tip) {
    cargo = {};
    add_bias(cargo, w);
    const Tip& tip = tree_->tips[static_cast<std::size_t>(l.record)];
    set_tip(tip, w.h, r.M);
    inverse = S(tip.inverse);
  } else {
    add_body(cargo.M, l);
    add_bias(cargo, w);
    if (l.slot >= 0) add<false>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
    if (!all_positive(cargo.M.Izz)) return false;
    inverse = S(1.0) / cargo.M.Izz;
    eliminate_pin(cargo.M, inverse, w.h, r.M);
  }
  eliminate_bias(cargo, S(tau[l.u]), inverse, w, r);
  if (l.parent < 0) return true;
  turn_pin(r, angles_.cosine(k), angles_.sine(k), l.d, w);
  carry_any<false>(l, body(k).edge, r, cargo);
  if (!l.first) leave<false>(l, slot_of_parent(l), cargo);
  return true;
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::ball_inward(std::size_t k, const InTau& tau, Cargo<S>& cargo) {
  const Link& l = tree_->links[k];
  BallAcceleration<S>& w = balls_[static_cast<std::size_t>(l.record)];
  if (l.tip) cargo = {};
  add_body(cargo.M, l);
  if (l.slot >= 0) add<false>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
  Sym3<S> A;
  if (!w.pivot.eliminate(cargo.M, A)) return false;
  const Vec3<S> forces{{S(tau[l.u]), S(tau[l.u + 1]), S(tau[l.u + 2])}};
  const Vec3<S> e = forces - w.bn - Vec3<S>{{cargo.Dnx, cargo.Dny, cargo.Dnz}};
  const Vec3<S> reaction = w.pivot.remainder(e);
  if (l.parent < 0) return true;
  const Vec3<S> f = w.bf + Vec3<S>{{cargo.Dfx, cargo.Dfy, cargo.Dfz}} + reaction + A * w.cl;
  carry_ball(tree_->balls[static_cast<std::size_t>(l.record)].origin, w.R, A, f, forces, cargo);
  if (!l.first) leave<false>(l, slot_of_parent(l), cargo);
  return true;
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::general_inward(std::size_t k, const InTau& tau,
                                                    Cargo<S>& cargo) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  if (l.tip) cargo = {};
  add_body(cargo.M, l);
  if (l.slot >= 0) add<false>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
  x.M = blocks(cargo.M);
  x.D += remainder_of(cargo);
  S forces[6]{};
  for (int i = 0; i < b.nv; ++i) forces[i] = S(tau[b.u + i]);
  Spatial::ArticulatedInertia<S> M;
  if (!eliminate<Spatial>(b, x, M)) return false;
  auto D = remainder<Spatial>(b, x, forces);
  if (b.parent < 0) return true;
  D += reduced_momentum<Spatial>(b, x, x.c);
  set_cargo(cargo, Spatial::to_parent(b.edge, b.kind, x.edge, M),
            Spatial::to_parent(b.edge, b.kind, x.edge, D), Vec3<S>{});
  if (!l.first) leave<false>(l, slot_of_parent(l), cargo);
  return true;
}

template <class S>
template <class Out>
void AccelerationSweeps<Spatial, S>::outward(Out udot) {
  const Link* links = tree_->links.data();
  const auto& gravity = tree_->model->gravity;
  const S zero(0.0);
  S vx = zero, vy = zero, vz = zero, ox = zero, oy = zero, oz = zero, x;
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Link& l = links[k];
    if (l.parent >= 0 && !l.first) {
      const auto& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      vx = from.vx;
      vy = from.vy;
      vz = from.vz;
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
    } else if (l.parent < 0) {
      vx = S(-gravity[0]);
      vy = S(-gravity[1]);
      vz = S(-gravity[2]);
      ox = oy = oz = zero;
    }
    if (l.kind != LinkKind::pin) {
      OutwardCargo<S> here{vx, vy, vz, ox, oy, oz, zero, zero, zero};
      general_outward(k, udot, here);
      vx = here.vx;
      vy = here.vy;
      vz = here.vz;
      ox = here.ox;
      oy = here.oy;
      oz = here.oz;
    } else {
      const PinAcceleration<S>& w = pins_[k];
      const S c = angles_.cosine(k), s = angles_.sine(k);
      if (l.parent < 0) {
        const Vec3<double>& at = tree_->weight[k];
        vx = -(c * at[0] + s * at[1]);
        vy = -(c * at[1] - s * at[0]);
        vz = S(-at[2]);
        oz = w.y0 - (w.h.fx * vx + w.h.fy * vy + w.h.fz * vz);
        udot[l.u] = oz;
      } else {
        constants_outward(l, body(k).edge, vx, vy, vz, ox, oy, oz);
        vx = vx + w.clx;
        vy = vy + w.cly;
        vz = vz + w.clz;
        ox = ox + w.cox;
        oy = oy + w.coy;
        vx = vx + l.d * oy;
        vy = vy - l.d * ox;
        x = c * vx + s * vy;
        vy = c * vy - s * vx;
        vx = x;
        x = c * ox + s * oy;
        oy = c * oy - s * ox;
        ox = x;
        const S wz = w.y0 - (w.h.fx * vx + w.h.fy * vy + w.h.fz * vz + w.h.nx * ox + w.h.ny * oy);
        udot[l.u] = wz - oz;
        oz = wz;
      }
    }
    if (l.slot >= 0)
      outward_slots_[static_cast<std::size_t>(l.slot)] = {vx, vy, vz, ox, oy, oz, zero, zero, zero};
  }
}

template <class S>
template <class Out>
void AccelerationSweeps<Spatial, S>::general_outward(std::size_t k, Out udot, OutwardCargo<S>& c) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  Spatial::Motion<S> V{{{c.vx, c.vy, c.vz}}, {{c.ox, c.oy, c.oz}}};
  if (l.kind == LinkKind::ball) {
    const auto& w = balls_[static_cast<std::size_t>(l.record)];
    const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
    if (l.parent >= 0) V.v += cross(V.w, Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}});
    V = {transpose_times(w.R, V.v), transpose_times(w.R, V.w)};
    V.v += w.cl;
    V.w += w.co;
    const Vec3<S> alpha = w.pivot.omega(V.v);
    for (int i = 0; i < 3; ++i) udot[l.u + i] = alpha[i] - V.w[i];
    V.w = alpha;
  } else {
    const auto& x = joints_[static_cast<std::size_t>(l.record)];
    if (l.parent >= 0)
      V = Spatial::to_child(b.edge, b.kind, x.edge, V);
    else
      V.v = Spatial::direction_to_child(b.edge, b.kind, x.edge, V.v);
    V += x.c;
    S own[6];
    solve_joint<Spatial>(b, x, V, own);
    for (int i = 0; i < b.nv; ++i) udot[b.u + i] = own[i];
  }
  set_cargo(c, V, Vec3<S>{});
}

}  // namespace momenta
