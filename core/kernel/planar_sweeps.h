#pragma once
// Both recursions in a plane: (q, p, t) → (u, ṗ), eqs. (35), (37)-(48), and its acceleration twin,
// for trees of any planar joints. Three-component algebra in ground axes about each body's own
// joint: no matrix is ever turned. For a pin K, r the way from its parent's joint:
//
//   inward    M_j⁻¹ = 1/I, h = H/I, A' = A − H hᵀ, D' = D + h e, D'_n = p          (46)-(48)
//             to the parent: A', H = A' ρ, I = r × H, D_n = p + r × D', ρ = (−r_y, r_x)   (43),
//             (44)
//   outward   v += ω_L ρ, ω = M_j⁻¹ e − h·v, u = ω − ω_L                             (45)
//             P* = A' v + D', ṗ = weight's moment − v × P*                            (42), (35)
//
// The moment of the subtree's weight about O rides inward as one number. In the acceleration form
// the velocity product of a pin is −ω_L² r, the bias of a body −ω² m c.

#include <momenta/core/kernel/general_joint.h>
#include <momenta/core/kernel/planar_link.h>
#include <momenta/core/kernel/sweeps.h>

namespace momenta {

template <class Space, class S>
class MomentumSweeps;
template <class Space, class S>
class AccelerationSweeps;

/// What bodies pass inward, and outward.
template <class S>
struct PlanarCargo {
  S Axx, Axy, Ayy, Hx, Hy, I, Dx, Dy, Dn, G;
};
template <class S>
struct PlanarMotion {
  S vx, vy, omega;
};

template <class S>
struct PlanarPin {
  S rx, ry;          ///< O_K − O_L
  S Axx, Axy, Ayy;   ///< A'
  S Dx, Dy, hx, hy;  ///< D', h
  S inverse, y0, G;  ///< M_j⁻¹, M_j⁻¹ e, moment of the subtree's weight
  S kx, ky;          ///< own first moment; in the acceleration form
};

/// Absolute angles of all bodies, their sines and cosines, joints of the general links.
template <class S>
class PlanarPlaces {
 public:
  explicit PlanarPlaces(const PlanarTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        pins_(tree.links.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(static_cast<std::size_t>(tree.slots)) {}
  int stuck() const { return stuck_; }

 protected:
  template <class In>
  void place(const S& t, const In& q) {
    const PlanarLink* links = tree_->links.data();
    const std::size_t n = angles_.size();
    for (std::size_t k = 0; k < n; ++k) {
      const PlanarLink& l = links[k];
      S angle(tree_->theta0[k]);
      if (l.parent >= 0) angle += angles_[static_cast<std::size_t>(l.parent)];
      if (l.pin) {
        angles_.set(k, angle + l.sign * q[l.q]);
        continue;
      }
      const auto& b = body(k);
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      if (b.drive >= 0)
        prescribe(tree_->model->drives[static_cast<std::size_t>(b.drive)], t, x.drive, x.drive_rate,
                  x.drive_acceleration);
      x.value = b.drive >= 0 ? x.drive : b.nq == 1 ? S(q[b.q]) : S(0.0);
      if (b.kind == JointKind::revolute) angle += l.sign * x.value;
      angles_.set(k, angle);
    }
    angles_.turn();
    if (joints_.empty()) return;
    for (std::size_t k = 0; k < n; ++k) {
      const PlanarLink& l = links[k];
      if (l.pin) continue;
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      x.edge.r = step(l);
      x.edge.sign = S(l.sign);
      if (body(k).kind != JointKind::prismatic) continue;
      x.edge.slide = turned(l.parent, l.slide_x, l.slide_y);
      x.edge.r += x.value * x.edge.slide;
    }
  }

  /// A vector of the parent's frame in ground axes.
  Vec2<S> turned(int parent, double x, double y) const {
    if (parent < 0) return {{S(x), S(y)}};
    const auto k = static_cast<std::size_t>(parent);
    return {
        {angles_.cosine(k) * x - angles_.sine(k) * y, angles_.sine(k) * x + angles_.cosine(k) * y}};
  }
  /// O_K − O_L while the joint rests at zero.
  MOMENTA_INLINE Vec2<S> step(const PlanarLink& l) const {
    if (!l.first) return turned(l.parent, l.x, l.y);
    const auto k = static_cast<std::size_t>(l.parent);
    return {{l.x * angles_.cosine(k), l.x * angles_.sine(k)}};
  }
  const Model<Planar>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  PlanarCargo<S>& slot_of_parent(const PlanarLink& l) {
    return slots_[static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }
  /// Ω of the parent's joint, when that is not the body before.
  const PlanarMotion<S>& motion_of_parent(const PlanarLink& l) const {
    return outward_slots_[static_cast<std::size_t>(
        tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }

  static MOMENTA_INLINE void add(PlanarCargo<S>& a, const PlanarCargo<S>& b) {
    a.Axx = a.Axx + b.Axx;
    a.Axy = a.Axy + b.Axy;
    a.Ayy = a.Ayy + b.Ayy;
    a.Hx = a.Hx + b.Hx;
    a.Hy = a.Hy + b.Hy;
    a.I = a.I + b.I;
    a.Dx = a.Dx + b.Dx;
    a.Dy = a.Dy + b.Dy;
    a.Dn = a.Dn + b.Dn;
    a.G = a.G + b.G;
  }
  /// What a child beside the first leaves in its parent's slot.
  static MOMENTA_INLINE void leave(const PlanarLink& l, PlanarCargo<S>& slot,
                                   const PlanarCargo<S>& a) {
    if (l.opens)
      slot = a;
    else
      add(slot, a);
  }
  static MOMENTA_INLINE void add_body(PlanarCargo<S>& a, const PlanarLink& l, const S& kx,
                                      const S& ky) {
    a.Axx = a.Axx + l.m;
    a.Ayy = a.Ayy + l.m;
    a.Hx = a.Hx - ky;
    a.Hy = a.Hy + kx;
    a.I = a.I + l.J;
  }
  /// A', D' of a joint at O_K to O_L; D'_n = n.
  static MOMENTA_INLINE void carry(PlanarCargo<S>& a, const S& rx, const S& ry, const S& n) {
    a.Hx = a.Axy * rx - a.Axx * ry;
    a.Hy = a.Ayy * rx - a.Axy * ry;
    a.I = rx * a.Hy - ry * a.Hx;
    a.Dn = n + (rx * a.Dy - ry * a.Dx);
  }
  /// The same for M' and D' of any joint.
  static void carry(PlanarCargo<S>& a, const JointRecord<Planar, S>& x,
                    const Planar::ArticulatedInertia<S>& M, const Planar::Force<S>& D) {
    const auto m = Planar::to_parent({}, JointKind::weld, x.edge, M);
    const auto d = Planar::to_parent({}, JointKind::weld, x.edge, D);
    const S G = a.G;
    a = {m.xx, m.xy, m.yy, m.H[0], m.H[1], m.I, d.f[0], d.f[1], d.n, G};
  }
  static Planar::ArticulatedInertia<S> blocks(const PlanarCargo<S>& a) {
    return {a.Axx, a.Axy, a.Ayy, {{a.Hx, a.Hy}}, a.I};
  }

  const PlanarTree* tree_;
  Angles<S> angles_;
  std::vector<PlanarPin<S>> pins_;
  std::vector<JointRecord<Planar, S>> joints_;
  std::vector<PlanarCargo<S>> slots_;
  std::vector<PlanarMotion<S>> outward_slots_;
  int stuck_ = -1;
};

template <class S>
class MomentumSweeps<Planar, S> : PlanarPlaces<S> {
  using Base = PlanarPlaces<S>;
  using Base::joints_, Base::outward_slots_, Base::pins_, Base::slots_, Base::stuck_, Base::tree_;

 public:
  using Space = Planar;
  explicit MomentumSweeps(const PlanarTree& tree) : Base(tree), solution_(tree) {}
  using Base::stuck;

  /// u (nv) and the open chain's ṗ (nv), forces between points of bodies left out. False when a
  /// joint's articulated inertia is not positive: stuck(). O(bodies).
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& p, Out u, Out pdot) {
    Base::place(t, q);
    stuck_ = -1;
    return inward(p) && outward(q, u, pdot);
  }

  /// M⁻¹ x (nv) at the configuration of the last evaluation, prescribed motion left out:
  /// inverse_mass.h. O(bodies).
  template <class In, class Out>
  void inverse_mass_times(const In& x, Out result);
  /// The same on S or, from sweeps on directions, on packs of right-hand sides.
  /// @pre S, or pins alone.
  template <class X, class In, class Out>
  void inverse_mass_times(MassSolution<Planar, X>& solution, const In& x, Out result);

 private:
  template <class In>
  bool inward(const In& p);
  template <class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& p, PlanarCargo<S>& a);
  template <class In, class Out>
  bool outward(const In& q, Out u, Out pdot);
  template <class In, class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, const In& q, Out u, Out pdot,
                                                 PlanarMotion<S>& m);
  MassSolution<Planar, S> solution_;
};

template <class S>
template <class In>
bool MomentumSweeps<Planar, S>::inward(const In& p) {
  const PlanarLink* links = tree_->links.data();
  PlanarCargo<S> a{};
  for (std::size_t k = pins_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    if (!l.pin) {
      PlanarCargo<S> here = a;
      if (!general_inward(k, p, here)) {
        stuck_ = static_cast<int>(k);
        return false;
      }
      a = here;
      continue;
    }
    PlanarPin<S>& w = pins_[k];
    const S c = Base::angles_.cosine(k), s = Base::angles_.sine(k);
    const S kx = l.cx * c - l.cy * s, ky = l.cx * s + l.cy * c;
    if (l.tip) a = {};
    Base::add_body(a, l, kx, ky);
    a.G = a.G + (l.wx * c + l.wy * s);
    if (l.slot >= 0) Base::add(a, slots_[static_cast<std::size_t>(l.slot)]);
    if (!all_positive(a.I)) {
      stuck_ = static_cast<int>(k);
      return false;
    }
    w.inverse = S(1.0) / a.I;
    const S pk = l.sign < 0 ? -p[l.u] : S(p[l.u]);
    const S e = pk - a.Dn;
    w.y0 = e * w.inverse;
    w.G = a.G;
    if (l.parent < 0) continue;
    w.hx = a.Hx * w.inverse;
    w.hy = a.Hy * w.inverse;
    a.Axx = a.Axx - a.Hx * w.hx;
    a.Axy = a.Axy - a.Hx * w.hy;
    a.Ayy = a.Ayy - a.Hy * w.hy;
    a.Dx = a.Dx + w.hx * e;
    a.Dy = a.Dy + w.hy * e;
    w.Axx = a.Axx;
    w.Axy = a.Axy;
    w.Ayy = a.Ayy;
    w.Dx = a.Dx;
    w.Dy = a.Dy;
    const Vec2<S> r = Base::step(l);
    w.rx = r[0];
    w.ry = r[1];
    Base::carry(a, w.rx, w.ry, pk);
    if (!l.first) Base::leave(l, Base::slot_of_parent(l), a);
  }
  return true;
}

template <class S>
template <class In>
bool MomentumSweeps<Planar, S>::general_inward(std::size_t k, const In& p, PlanarCargo<S>& a) {
  const PlanarLink& l = tree_->links[k];
  const auto& b = Base::body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  const S c = Base::angles_.cosine(k), s = Base::angles_.sine(k);
  if (l.tip) a = {};
  Base::add_body(a, l, l.cx * c - l.cy * s, l.cx * s + l.cy * c);
  a.G += l.wx * c + l.wy * s;
  if (l.slot >= 0) Base::add(a, slots_[static_cast<std::size_t>(l.slot)]);
  x.M = Base::blocks(a);
  x.D = {{{a.Dx, a.Dy}}, a.Dn};
  x.moment = a.G;
  const S r = b.nv == 1 ? S(p[b.u]) : S(0.0);
  Planar::ArticulatedInertia<S> M;
  if (!eliminate<Planar>(b, x, M)) return false;
  auto D = remainder<Planar>(b, x, &r);
  if (b.drive >= 0) {  // M' = M*: its momentum under the prescribed rates Ω_t, (44)
    Planar::Motion<S> prescribed{};
    Joint<Planar>::add_motion(b, x.edge, &x.drive_rate, prescribed);
    D += Planar::momentum(x.M, prescribed);
  }
  if (b.parent < 0) return true;
  Base::carry(a, x, M, D);
  // The subtree's weight acts at the parent wherever this joint has moved to.
  const auto& g = tree_->model->gravity;
  a.G += b.subtree_mass * (x.edge.r[0] * g[1] - x.edge.r[1] * g[0]);
  if (!l.first) Base::leave(l, Base::slot_of_parent(l), a);
  return true;
}

template <class S>
template <class In, class Out>
bool MomentumSweeps<Planar, S>::outward(const In& q, Out u, Out pdot) {
  const PlanarLink* links = tree_->links.data();
  const S zero(0.0);
  S vx = zero, vy = zero, omega = zero;
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const PlanarLink& l = links[k];
    if (l.parent < 0) {
      vx = vy = omega = zero;
    } else if (!l.first) {
      const auto& from = Base::motion_of_parent(l);
      vx = from.vx;
      vy = from.vy;
      omega = from.omega;
    }
    if (!l.pin) {
      PlanarMotion<S> here{vx, vy, omega};
      general_outward(k, q, u, pdot, here);
      vx = here.vx;
      vy = here.vy;
      omega = here.omega;
    } else {
      const PlanarPin<S>& w = pins_[k];
      S own = w.y0, rate = w.G, turning = w.y0;
      if (l.parent >= 0) {
        vx = vx - omega * w.ry;
        vy = vy + omega * w.rx;
        const S Px = w.Axx * vx + w.Axy * vy + w.Dx, Py = w.Axy * vx + w.Ayy * vy + w.Dy;
        rate = w.G + (vy * Px - vx * Py);
        turning = w.y0 - (w.hx * vx + w.hy * vy);
        own = turning - omega;
      }
      omega = turning;
      if (l.sign < 0) {
        own = -own;
        rate = -rate;
      }
      if (l.has_force) rate = rate + joint_force(Base::body(k), S(q[l.q]), own);
      u[l.u] = own;
      pdot[l.u] = rate;
    }
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = {vx, vy, omega};
  }
  return true;
}

template <class S>
template <class In, class Out>
void MomentumSweeps<Planar, S>::general_outward(std::size_t k, const In& q, Out u, Out pdot,
                                                PlanarMotion<S>& m) {
  const auto& b = Base::body(k);
  const auto& x = joints_[static_cast<std::size_t>(tree_->links[k].record)];
  Planar::Motion<S> V{{{m.vx, m.vy}}, m.omega};
  if (b.parent >= 0) V = Planar::to_child({}, b.kind, x.edge, V);
  if (b.drive >= 0) Joint<Planar>::add_motion(b, x.edge, &x.drive_rate, V);
  if (b.nv == 1) {
    S own, rate;
    solve_joint<Planar>(b, x, V, &own);
    const auto& g = tree_->model->gravity;
    Planar::Force<S> net{{{S(b.subtree_mass * g[0]), S(b.subtree_mass * g[1])}}, x.moment};
    auto P = Planar::momentum(x.M, V);
    P += x.D;
    net -= Planar::cross_force(V, P);
    Joint<Planar>::project(b, x.edge, net, &rate);
    u[b.u] = own;
    pdot[b.u] = rate + joint_force(b, S(q[b.q]), own);
  }
  m = {V.v[0], V.v[1], V.w};
}

template <class S>
class AccelerationSweeps<Planar, S> : PlanarPlaces<S> {
  using Base = PlanarPlaces<S>;
  using Base::joints_, Base::outward_slots_, Base::pins_, Base::slots_, Base::stuck_, Base::tree_;

 public:
  using Space = Planar;
  using Base::Base, Base::stuck;

  /// u̇ (nv) from (q, u, t) and all generalised forces τ (nv) but the weights'. O(bodies).
  template <class In, class InTau, class Out>
  bool operator()(const S& t, const In& q, const In& u, const InTau& tau, Out udot) {
    Base::place(t, q);
    stuck_ = -1;
    velocities(u);
    if (!inward(tau)) return false;
    outward(udot);
    return true;
  }

 private:
  /// What a pin keeps: in `Dx`, `Dy` −ω² m c of its body, then c = −ω_L² r in `Axx`, `Axy`.
  template <class In>
  void velocities(const In& u);
  template <class InTau>
  bool inward(const InTau& tau);
  template <class Out>
  void outward(Out udot);
};

template <class S>
template <class In>
void AccelerationSweeps<Planar, S>::velocities(const In& u) {
  const PlanarLink* links = tree_->links.data();
  const S zero(0.0);
  S omega = zero;
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const PlanarLink& l = links[k];
    if (l.parent < 0)
      omega = zero;
    else if (!l.first)
      omega = Base::motion_of_parent(l).omega;
    PlanarPin<S>& w = pins_[k];
    const S c = Base::angles_.cosine(k), s = Base::angles_.sine(k), parent_squared = omega * omega;
    if (l.pin) {
      const Vec2<S> r = Base::step(l);
      w.rx = r[0];
      w.ry = r[1];
      w.Axx = -(parent_squared * w.rx);
      w.Axy = -(parent_squared * w.ry);
      omega = l.sign < 0 ? omega - u[l.u] : omega + u[l.u];
    } else {
      const auto& b = Base::body(k);
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      Planar::Motion<S> own{};
      const S rate = b.nv == 1 ? S(u[b.u]) : x.drive_rate;
      if (b.nv == 1 || b.drive >= 0) Joint<Planar>::add_motion(b, x.edge, &rate, own);
      omega += own.w;
      x.c = {{}, zero};
      if (l.parent >= 0) x.c.v -= parent_squared * x.edge.r;
      x.c.v += cross(S(2.0) * omega, own.v);
      if (b.drive >= 0) Joint<Planar>::add_motion(b, x.edge, &x.drive_acceleration, x.c);
    }
    w.kx = l.cx * c - l.cy * s;
    w.ky = l.cx * s + l.cy * c;
    const S squared = omega * omega;
    w.Dx = -(squared * w.kx);
    w.Dy = -(squared * w.ky);
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)].omega = omega;
  }
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Planar, S>::inward(const InTau& tau) {
  const PlanarLink* links = tree_->links.data();
  PlanarCargo<S> a{};
  for (std::size_t k = pins_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    PlanarPin<S>& w = pins_[k];
    if (l.tip) a = {};
    Base::add_body(a, l, w.kx, w.ky);
    a.Dx = a.Dx + w.Dx;
    a.Dy = a.Dy + w.Dy;
    if (l.slot >= 0) Base::add(a, slots_[static_cast<std::size_t>(l.slot)]);
    if (l.pin) {
      if (!all_positive(a.I)) {
        stuck_ = static_cast<int>(k);
        return false;
      }
      w.inverse = S(1.0) / a.I;
      const S n = l.sign < 0 ? -tau[l.u] : S(tau[l.u]), e = n - a.Dn;
      w.y0 = e * w.inverse;
      w.hx = a.Hx * w.inverse;
      w.hy = a.Hy * w.inverse;
      if (l.parent < 0) continue;
      a.Axx = a.Axx - a.Hx * w.hx;
      a.Axy = a.Axy - a.Hx * w.hy;
      a.Ayy = a.Ayy - a.Hy * w.hy;
      a.Dx = a.Dx + w.hx * e + (a.Axx * w.Axx + a.Axy * w.Axy);
      a.Dy = a.Dy + w.hy * e + (a.Axy * w.Axx + a.Ayy * w.Axy);
      Base::carry(a, w.rx, w.ry, n);
    } else {
      const auto& b = Base::body(k);
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      x.M = Base::blocks(a);
      x.D = {{{a.Dx, a.Dy}}, a.Dn};
      const S r = b.nv == 1 ? S(tau[b.u]) : S(0.0);
      Planar::ArticulatedInertia<S> M;
      if (!eliminate<Planar>(b, x, M)) {
        stuck_ = static_cast<int>(k);
        return false;
      }
      auto D = remainder<Planar>(b, x, &r);
      if (l.parent < 0) continue;
      D += reduced_momentum<Planar>(b, x, x.c);
      Base::carry(a, x, M, D);
    }
    if (!l.first) Base::leave(l, Base::slot_of_parent(l), a);
  }
  return true;
}

template <class S>
template <class Out>
void AccelerationSweeps<Planar, S>::outward(Out udot) {
  const PlanarLink* links = tree_->links.data();
  const auto& g = tree_->model->gravity;
  S vx{}, vy{}, alpha{};
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const PlanarLink& l = links[k];
    if (l.parent < 0) {
      vx = S(-g[0]);
      vy = S(-g[1]);
      alpha = S(0.0);
    } else if (!l.first) {
      const auto& from = Base::motion_of_parent(l);
      vx = from.vx;
      vy = from.vy;
      alpha = from.omega;
    }
    if (l.pin) {
      const PlanarPin<S>& w = pins_[k];
      if (l.parent >= 0) {
        vx = vx - alpha * w.ry + w.Axx;
        vy = vy + alpha * w.rx + w.Axy;
      }
      const S turning = w.y0 - (w.hx * vx + w.hy * vy), own = turning - alpha;
      udot[l.u] = l.sign < 0 ? -own : own;
      alpha = turning;
    } else {
      const auto& b = Base::body(k);
      const auto& x = joints_[static_cast<std::size_t>(l.record)];
      Planar::Motion<S> V{{{vx, vy}}, alpha};
      if (l.parent >= 0) V = Planar::to_child({}, b.kind, x.edge, V);
      V += x.c;
      if (b.nv == 1) {
        S own;
        solve_joint<Planar>(b, x, V, &own);
        udot[b.u] = own;
      }
      vx = V.v[0];
      vy = V.v[1];
      alpha = V.w;
    }
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = {vx, vy, alpha};
  }
}

}  // namespace momenta
