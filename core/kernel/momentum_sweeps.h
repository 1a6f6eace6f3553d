#pragma once
// The recursion of the paper in space, (q, p, t) → (u, ṗ) in two sweeps, eqs. (35), (37)-(48), for
// trees of any joints. For a single pin K with parent L, in the order of the code:
//
//   inward    M*_K, D_K, G_K are complete             (43), (44); G: first moment of the subtree
//             M_j⁻¹ = 1 / I_zz, h = M*E M_j⁻¹          (46)
//             e = p − Eᵀ D = p − D_nz
//             M' = M* − M*E hᵀ, D' = D + h e           (47), (48); D'_nz = p exactly
//             M*_L += 𝒯ᶠ M' 𝒯ⱽ, D_L += 𝒯ᶠ D', G_L += … (43), (44)
//   outward   W = 𝒯ⱽ Ω_L, u = M_j⁻¹ e − hᵀ W           (45); the last entry of h is 1
//             P* = M' W + D'                           (42)
//             ṗ = Eᵀ (T* − W × P*) + joint force       (35), T* = weight of the subtree at G
//
// Ω × P* about the pin's axis does not change when frames are turned about and shifted along it, so
// it is formed in the frame in which M' lies stored, after the pin's own screw: four of the six
// rows of P* suffice, and W for Ω, because E u adds nothing about its own axis. Weight needs no
// accumulated T*: masses of subtrees are constants.
//
// What a body passes to its parent stays in registers when the parent is the body before it; other
// children leave it in the parent's slot. Wrenches between points of bodies need a third sweep.

#include <momenta/core/kernel/forces.h>
#include <momenta/core/kernel/pin.h>
#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// What the outward sweep needs of a pin.
template <class S>
struct PinRecord {
  Reduced<S> M;  ///< M' after the pin's screw
  PinColumn<S> h;
  S Dfx, Dfy, Dnx, Dny;  ///< D' there
  S inverse, y0;         ///< M_j⁻¹, M_j⁻¹ e
  S Gx, Gy;              ///< across the pin, body axes
};

/// What it needs of a ball joint. R: child components to the parent's.
template <class S>
struct BallRecord {
  Mat3<S> R;
  BallPivot<S> pivot;
  Sym3<S> A;         ///< M' = (A, 0; 0, 0)
  Vec3<S> Df, p, G;  ///< D' = (Df, p); first moment of the subtree
};

template <class Space, class S>
class MomentumSweeps;

template <class S>
class MomentumSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit MomentumSweeps(const LinkTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        pins_(tree.links.size()),
        balls_(tree.balls.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        users_(static_cast<std::size_t>(tree.users)),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(static_cast<std::size_t>(tree.slots)),
        solution_(tree) {}

  /// u (nv) and the open chain's ṗ (nv), forces between points of bodies left out. In and Out index
  /// like pointers to S. False when a joint's articulated inertia is not positive: stuck().
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& p, Out u, Out pdot) {
    place_links(
        *tree_, t, q, angles_, joints_,
        users_, [&](std::size_t record) -> auto& { return balls_[record].R; });
    stuck_ = tree_->stuck;
    if (stuck_ >= 0) return false;
    return tree_->model->has_gravity ? inward<true>(p) && outward<true>(q, u, pdot)
                                     : inward<false>(p) && outward<false>(q, u, pdot);
  }

  /// M⁻¹ x (nv) at the configuration of the last evaluation, prescribed motion left out:
  /// inverse_mass.h. O(bodies).
  template <class In, class Out>
  void inverse_mass_times(const In& x, Out result);
  /// The same on S or, from sweeps on directions, on packs of right-hand sides.
  /// @pre S, or pins alone.
  template <class X, class In, class Out>
  void inverse_mass_times(MassSolution<Spatial, X>& solution, const In& x, Out result);

  int stuck() const { return stuck_; }

 private:
  template <bool Gravity, class In>
  bool inward(const In& p);
  template <bool Gravity, class In, class Out>
  bool outward(const In& q, Out u, Out pdot);

  // Out of line: what the loop over a chain holds in registers must have no address.
  template <Turn turn, bool Gravity, class In>
  __attribute__((noinline)) std::size_t chain_inward(std::size_t end, const In& p, Cargo<S>& cargo);
  template <bool Gravity, class In>
  __attribute__((noinline)) bool pin_inward(std::size_t k, const In& p, Cargo<S>& cargo);
  template <bool Gravity, class In>
  __attribute__((noinline)) bool ball_inward(std::size_t k, const In& p, Cargo<S>& cargo);
  template <bool Gravity, class Out>
  __attribute__((noinline)) void ball_outward(std::size_t k, Out u, Out pdot,
                                              OutwardCargo<S>& cargo);
  template <bool Gravity, class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& p, Cargo<S>& cargo);
  template <bool Gravity, class In, class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, const In& q, Out u, Out pdot,
                                                 OutwardCargo<S>& cargo);
  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  Cargo<S>& slot_of_parent(const Link& l) {
    return slots_[static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }

  const LinkTree* tree_;
  Angles<S> angles_;
  std::vector<PinRecord<S>> pins_;
  std::vector<BallRecord<S>> balls_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<Cargo<S>> slots_;
  std::vector<OutwardCargo<S>> outward_slots_;
  MassSolution<Spatial, S> solution_;
  int stuck_ = -1;
};

/// (46)-(48) of a pin whose M*, D, G are complete.
template <bool Gravity, class S>
MOMENTA_INLINE void eliminate_pin(const Cargo<S>& cargo, const S& p, const S& inverse,
                                  PinRecord<S>& w, Eliminated<S>& r) {
  const S e = p - cargo.Dnz;
  w.inverse = inverse;
  w.y0 = e * inverse;
  PinColumn<S> h;
  eliminate_pin(cargo.M, inverse, h, r.M);
  w.h = h;
  r.fx = cargo.Dfx + h.fx * e;
  r.fy = cargo.Dfy + h.fy * e;
  r.fz = cargo.Dfz + h.fz * e;
  r.nx = cargo.Dnx + h.nx * e;
  r.ny = cargo.Dny + h.ny * e;
  r.nz = p;
  if constexpr (Gravity) {
    w.Gx = r.Gx = cargo.Gx;
    w.Gy = r.Gy = cargo.Gy;
    r.Gz = cargo.Gz;
  }
}

/// The pin's own screw; what the outward sweep needs is stored on the way.
template <bool Gravity, class S>
MOMENTA_INLINE void turn_pin(Eliminated<S>& r, const S& c, const S& s, double d, PinRecord<S>& w) {
  turn_and_shift_z(r.M, c, s, d);
  w.M = r.M;
  S x = c * r.fx - s * r.fy;
  r.fy = s * r.fx + c * r.fy;
  r.fx = x;
  x = c * r.nx - s * r.ny;
  r.ny = s * r.nx + c * r.ny;
  r.nx = x - d * r.fy;
  r.ny = r.ny + d * r.fx;
  w.Dfx = r.fx;
  w.Dfy = r.fy;
  w.Dnx = r.nx;
  w.Dny = r.ny;
  if constexpr (Gravity) {
    x = c * r.Gx - s * r.Gy;
    r.Gy = s * r.Gx + c * r.Gy;
    r.Gx = x;
  }
}

template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::inward(const In& p) {
  const Link* links = tree_->links.data();
  Cargo<S> cargo{};  // of the body after the next one
  for (std::size_t k = angles_.size(); k > 0;) {
    switch (links[k - 1].path) {
      case Path::chain_general:
        k = chain_inward<Turn::general, Gravity>(k, p, cargo);
        break;
      case Path::chain_right:
        k = chain_inward<Turn::right, Gravity>(k, p, cargo);
        break;
      case Path::chain_parallel:
        k = chain_inward<Turn::parallel, Gravity>(k, p, cargo);
        break;
      case Path::any:
        --k;
        if (!(links[k].kind == LinkKind::pin    ? pin_inward<Gravity>(k, p, cargo)
              : links[k].kind == LinkKind::ball ? ball_inward<Gravity>(k, p, cargo)
                                                : general_inward<Gravity>(k, p, cargo)))
          stuck_ = static_cast<int>(k);
        break;
    }
    if (stuck_ >= 0) return false;
  }
  return true;
}

/// Pins inside a chain from `end` − 1 down, as far as their turns are of one kind; returns the end
/// of what is left. All that passes from body to body stays in registers.
template <class S>
template <Turn turn, bool Gravity, class In>
std::size_t MomentumSweeps<Spatial, S>::chain_inward(std::size_t end, const In& p, Cargo<S>& from) {
  Cargo<S> cargo = from;
  const Link* links = tree_->links.data();
  std::size_t k = end;
  do {
    --k;
    const Link& l = links[k];
    PinRecord<S>& w = pins_[k];
    add_body(cargo.M, l);
    if constexpr (Gravity) {
      cargo.Gx = cargo.Gx + l.moment[0];
      cargo.Gy = cargo.Gy + l.moment[1];
      cargo.Gz = cargo.Gz + l.moment[2];
    }
    if (!all_positive(cargo.M.Izz)) {
      stuck_ = static_cast<int>(k);
      return k;
    }
    Eliminated<S> r;
    eliminate_pin<Gravity>(cargo, p[l.u], S(1.0) / cargo.M.Izz, w, r);
    turn_pin<Gravity>(r, angles_.cosine(k), angles_.sine(k), l.d, w);
    carry<turn, Gravity>(r, l, cargo);
  } while (links[k - 1].path == static_cast<Path>(turn));
  from = cargo;
  return k;
}

/// Any other pin: at a tip, at a branch, on the ground, beside a first child.
template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::pin_inward(std::size_t k, const In& p, Cargo<S>& cargo) {
  const Link& l = tree_->links[k];
  PinRecord<S>& w = pins_[k];
  const S pk = p[l.u];
  Eliminated<S> r;
  if (l.tip) {
    const Tip& tip = tree_->tips[static_cast<std::size_t>(l.record)];
    set_tip(tip, w.h, r.M);
    w.inverse = S(tip.inverse);
    w.y0 = pk * tip.inverse;
    r.fx = pk * tip.h[0];
    r.fy = pk * tip.h[1];
    r.fz = pk * tip.h[2];
    r.nx = pk * tip.h[3];
    r.ny = pk * tip.h[4];
    r.nz = pk;
    if constexpr (Gravity) {
      w.Gx = r.Gx = S(l.moment[0]);
      w.Gy = r.Gy = S(l.moment[1]);
      r.Gz = S(l.moment[2]);
    }
    if (l.parent < 0) return true;
  } else {
    add_body(cargo.M, l);
    if constexpr (Gravity) {
      cargo.Gx = cargo.Gx + l.moment[0];
      cargo.Gy = cargo.Gy + l.moment[1];
      cargo.Gz = cargo.Gz + l.moment[2];
    }
    if (l.slot >= 0) add<Gravity>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
    if (!all_positive(cargo.M.Izz)) return false;
    const S inverse = S(1.0) / cargo.M.Izz;
    if (l.parent < 0) {  // nothing is passed on to the ground
      w.inverse = inverse;
      w.y0 = (pk - cargo.Dnz) * inverse;
      if constexpr (Gravity) {
        w.Gx = cargo.Gx;
        w.Gy = cargo.Gy;
      }
      return true;
    }
    eliminate_pin<Gravity>(cargo, pk, inverse, w, r);
  }
  turn_pin<Gravity>(r, angles_.cosine(k), angles_.sine(k), l.d, w);
  carry_any<Gravity>(l, body(k).edge, r, cargo);
  if (!l.first) leave<Gravity>(l, slot_of_parent(l), cargo);
  return true;
}

template <class S>
template <bool Gravity, class In, class Out>
bool MomentumSweeps<Spatial, S>::outward(const In& q, Out u, Out pdot) {
  const Link* links = tree_->links.data();
  const std::size_t n = angles_.size();
  // Velocity of O, angular velocity, gravity: of the body before, then of this one.
  const S zero(0.0);
  S vx = zero, vy = zero, vz = zero, ox = zero, oy = zero, oz = zero, gx = zero, gy = zero,
    gz = zero;
  for (std::size_t k = 0; k < n; ++k) {
    const Link& l = links[k];
    if (!l.first && l.parent >= 0) {
      const auto& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      vx = from.vx;
      vy = from.vy;
      vz = from.vz;
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
      if constexpr (Gravity) {
        gx = from.gx;
        gy = from.gy;
        gz = from.gz;
      }
    }
    if (l.kind != LinkKind::pin) {
      OutwardCargo<S> here{vx, vy, vz, ox, oy, oz, gx, gy, gz};
      if (l.kind == LinkKind::ball)
        ball_outward<Gravity>(k, u, pdot, here);
      else
        general_outward<Gravity>(k, q, u, pdot, here);
      vx = here.vx;
      vy = here.vy;
      vz = here.vz;
      ox = here.ox;
      oy = here.oy;
      oz = here.oz;
      if constexpr (Gravity) {
        gx = here.gx;
        gy = here.gy;
        gz = here.gz;
      }
    } else {
      const PinRecord<S>& w = pins_[k];
      const S c = angles_.cosine(k), s = angles_.sine(k);
      S x, wz, own, rate;
      if (l.parent < 0) {
        rate = zero;
        if constexpr (Gravity) {
          const Vec3<double>& at = tree_->weight[k];
          gx = c * at[0] + s * at[1];
          gy = c * at[1] - s * at[0];
          gz = S(at[2]);
          rate = w.Gx * gy - w.Gy * gx;
        }
        vx = vy = vz = ox = oy = zero;
        own = wz = w.y0;
      } else {
        // The constant screws.
        constants_outward(l, body(k).edge, vx, vy, vz, ox, oy, oz);
        if constexpr (Gravity) constants_outward(l, body(k).edge, gx, gy, gz);
        // P* = M' W + D' and its moment Eᵀ(W × P*), in the frame before the pin's screw.
        const Reduced<S>& m = w.M;
        const S Pfx = m.Axx * vx + m.Axy * vy + m.Axz * vz + m.Hxx * ox + m.Hxy * oy + w.Dfx;
        const S Pfy = m.Axy * vx + m.Ayy * vy + m.Ayz * vz + m.Hyx * ox + m.Hyy * oy + w.Dfy;
        const S Pnx = m.Hxx * vx + m.Hyx * vy + m.Hzx * vz + m.Ixx * ox + m.Ixy * oy + w.Dnx;
        const S Pny = m.Hxy * vx + m.Hyy * vy + m.Hzy * vz + m.Ixy * ox + m.Iyy * oy + w.Dny;
        rate = vy * Pfx - vx * Pfy + oy * Pnx - ox * Pny;
        // The pin's screw.
        vx = vx + l.d * oy;
        vy = vy - l.d * ox;
        x = c * vx + s * vy;
        vy = c * vy - s * vx;
        vx = x;
        x = c * ox + s * oy;
        oy = c * oy - s * ox;
        ox = x;
        if constexpr (Gravity) {
          x = c * gx + s * gy;
          gy = c * gy - s * gx;
          gx = x;
          rate = rate + w.Gx * gy - w.Gy * gx;
        }
        wz = w.y0 - (w.h.fx * vx + w.h.fy * vy + w.h.fz * vz + w.h.nx * ox + w.h.ny * oy);
        own = wz - oz;
      }
      oz = wz;
      if (l.has_force) rate = rate + joint_force(body(k), S(q[l.q]), own);
      u[l.u] = own;
      pdot[l.u] = rate;
    }
    if (l.slot >= 0)
      outward_slots_[static_cast<std::size_t>(l.slot)] = {vx, vy, vz, ox, oy, oz, gx, gy, gz};
  }
  return true;
}

// A ball joint leaves its body no angular inertia towards the parent: M' = (A', 0; 0, 0) with
// A' = A − H I⁻¹ Hᵀ, D' = (D_f + H I⁻¹ e, p). What arrives at the parent is A' turned, and what its
// step r makes of it: H = −A r̃, I = r̃ H.
template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::ball_inward(std::size_t k, const In& p, Cargo<S>& cargo) {
  const Link& l = tree_->links[k];
  BallRecord<S>& w = balls_[static_cast<std::size_t>(l.record)];
  if (l.tip) cargo = {};
  add_body(cargo.M, l);
  if constexpr (Gravity) {
    cargo.Gx = cargo.Gx + l.moment[0];
    cargo.Gy = cargo.Gy + l.moment[1];
    cargo.Gz = cargo.Gz + l.moment[2];
    w.G = {{cargo.Gx, cargo.Gy, cargo.Gz}};
  }
  if (l.slot >= 0) {
    add<Gravity>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
    if constexpr (Gravity) w.G = {{cargo.Gx, cargo.Gy, cargo.Gz}};
  }
  w.p = {{p[l.u], p[l.u + 1], p[l.u + 2]}};
  if (!w.pivot.eliminate(cargo.M, w.A)) return false;
  const Vec3<S> e{{w.p[0] - cargo.Dnx, w.p[1] - cargo.Dny, w.p[2] - cargo.Dnz}};
  w.Df = Vec3<S>{{cargo.Dfx, cargo.Dfy, cargo.Dfz}} + w.pivot.remainder(e);
  if (l.parent < 0) return true;

  carry_ball(tree_->balls[static_cast<std::size_t>(l.record)].origin, w.R, w.A, w.Df, w.p, cargo);
  if constexpr (Gravity) {
    const Vec3<S> G = w.R * w.G;
    cargo.Gx = G[0];
    cargo.Gy = G[1];
    cargo.Gz = G[2];
  }
  if (!l.first) leave<Gravity>(l, slot_of_parent(l), cargo);
  return true;
}

template <class S>
template <bool Gravity, class Out>
void MomentumSweeps<Spatial, S>::ball_outward(std::size_t k, Out u, Out pdot, OutwardCargo<S>& c) {
  const Link& l = tree_->links[k];
  const BallRecord<S>& w = balls_[static_cast<std::size_t>(l.record)];
  Vec3<S> v{}, o{}, g{};
  if (l.parent >= 0) {
    const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
    v = transpose_times(w.R,
                        Vec3<S>{{c.vx + c.oy * r[2] - c.oz * r[1], c.vy + c.oz * r[0] - c.ox * r[2],
                                 c.vz + c.ox * r[1] - c.oy * r[0]}});
    o = transpose_times(w.R, Vec3<S>{{c.ox, c.oy, c.oz}});
    if constexpr (Gravity) g = transpose_times(w.R, Vec3<S>{{c.gx, c.gy, c.gz}});
  } else if constexpr (Gravity) {
    const auto& at = tree_->model->gravity;
    g = transpose_times(w.R, Vec3<S>{{S(at[0]), S(at[1]), S(at[2])}});
  }
  const Vec3<S> omega = w.pivot.omega(v);
  const Vec3<S> Pf = w.A * v + w.Df;
  Vec3<S> net = -(cross(v, Pf) + cross(omega, w.p));
  if constexpr (Gravity) net += cross(w.G, g);
  for (int i = 0; i < 3; ++i) {
    u[l.u + i] = omega[i] - o[i];
    pdot[l.u + i] = net[i];
  }
  set_cargo(c, Spatial::Motion<S>{v, omega}, g);
}

template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::general_inward(std::size_t k, const In& p, Cargo<S>& cargo) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  if (l.tip) cargo = {};
  add_body(cargo.M, l);
  cargo.Gx += l.moment[0];
  cargo.Gy += l.moment[1];
  cargo.Gz += l.moment[2];
  if (l.slot >= 0) add<Gravity>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
  x.M = blocks(cargo.M);
  x.D = remainder_of(cargo);
  x.moment = {{cargo.Gx, cargo.Gy, cargo.Gz}};
  S r[6]{};
  for (int i = 0; i < b.nv; ++i) r[i] = p[b.u + i];
  Spatial::ArticulatedInertia<S> M;
  if (!eliminate<Spatial>(b, x, M)) return false;
  auto D = remainder<Spatial>(b, x, r);
  if (b.drive >= 0) {  // M' = M*: its momentum under the prescribed rates Ω_t, (44)
    Spatial::Motion<S> prescribed{};
    Joint<Spatial>::add_motion(b, x.edge, &x.drive_rate, prescribed);
    D += Spatial::momentum(x.M, prescribed);
  }
  if (b.law) D += reduced_momentum<Spatial>(b, x, x.user->motion.drift);
  if (b.parent < 0) return true;
  Vec3<S> G{};
  if constexpr (Gravity)
    G = Spatial::moment_to_parent(b.edge, b.kind, x.edge, x.moment, b.subtree_mass);
  set_cargo(cargo, Spatial::to_parent(b.edge, b.kind, x.edge, M),
            Spatial::to_parent(b.edge, b.kind, x.edge, D), G);
  if (!l.first) leave<Gravity>(l, slot_of_parent(l), cargo);
  return true;
}

template <class S>
template <bool Gravity, class In, class Out>
void MomentumSweeps<Spatial, S>::general_outward(std::size_t k, const In& q, Out u, Out pdot,
                                                 OutwardCargo<S>& c) {
  const auto& b = body(k);
  const auto& x = joints_[static_cast<std::size_t>(tree_->links[k].record)];
  Spatial::Motion<S> V{};
  Vec3<S> g{};
  if (b.parent >= 0) {
    V = Spatial::to_child(b.edge, b.kind, x.edge,
                          Spatial::Motion<S>{{{c.vx, c.vy, c.vz}}, {{c.ox, c.oy, c.oz}}});
    g = {{c.gx, c.gy, c.gz}};
  } else {
    for (int i = 0; i < 3; ++i) g[i] = S(tree_->model->gravity[i]);
  }
  if constexpr (Gravity) g = Spatial::direction_to_child(b.edge, b.kind, x.edge, g);
  if (b.drive >= 0) Joint<Spatial>::add_motion(b, x.edge, &x.drive_rate, V);
  if (b.law) V += x.user->motion.drift;
  if (b.nv > 0) {
    S own[6];
    solve_joint<Spatial>(b, x, V, own);
    Spatial::Force<S> net{};
    if constexpr (Gravity) net = Spatial::weight(S(b.subtree_mass), x.moment, g);
    auto P = Spatial::momentum(x.M, V);  // (42)
    P += x.D;
    net -= Spatial::cross_force(V, P);
    S rate[6];
    Joint<Spatial>::project(b, x.edge, net, rate);  // (35)
    if (b.law) {
      Joint<Spatial>::move(b, x.edge, static_cast<const S*>(own));
      Joint<Spatial>::add_axis_rate(b, x.edge, P, rate);
    }
    if (b.nv == 1 && tree_->model->has_joint_forces) rate[0] += joint_force(b, S(q[b.q]), own[0]);
    for (int i = 0; i < b.nv; ++i) {
      u[b.u + i] = own[i];
      pdot[b.u + i] = rate[i];
    }
  }
  set_cargo(c, V, g);
}

}  // namespace momenta
