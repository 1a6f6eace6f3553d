#pragma once
// The recursion of the paper in a plane, (q, p, t) → (u, ṗ), eqs. (35), (37)-(48), for trees of any
// planar joints. Three-component algebra in ground axes about each body's own joint: no matrix is
// turned. For a revolute joint K, r the way from its parent's joint:
//
//   inward    M_j⁻¹ = 1/I, h = H/I, A' = A − H hᵀ, D' = D + h e, D'_n = p          (46)-(48)
//             to the parent: A', H = A' ρ, I = r × H, D_n = p + r × D', ρ = (−r_y, r_x)   (43),
//             (44)
//   outward   v += ω_L ρ, ω = M_j⁻¹ e − h·v, u = ω − ω_L                             (45)
//             P* = A' v + D', ṗ = weight's moment − v × P*                            (42), (35)
//
// The moment of the subtree's weight about O goes inward as one number.

#include <momenta/core/kernel/planar_places.h>

namespace momenta {

template <class Space, class S>
class MomentumSweeps;

template <class S>
class MomentumSweeps<Planar, S> : PlanarPlaces<S> {
  using Base = PlanarPlaces<S>;
  using Base::joints_, Base::outward_slots_, Base::revolutes_, Base::slots_, Base::singular_joint_,
      Base::tree_;

 public:
  using Space = Planar;
  explicit MomentumSweeps(const PlanarTree& tree) : Base(tree), solution_(tree) {}
  using Base::singular_joint;

  /// u (nv) and the open chain's ṗ (nv), without forces between points of bodies. False at a
  /// singular joint: singular_joint(). O(bodies).
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& p, Out u, Out pdot) {
    Base::place(t, q);
    singular_joint_ = -1;
    return inward(p) && outward(q, u, pdot);
  }

  /// M⁻¹ x (nv) at the last configuration, without prescribed motion: inverse_mass.h. O(bodies).
  template <class In, class Out>
  void inverse_mass_times(const In& x, Out result);
  /// The same for S or, after sweeps on directions, for packs of right-hand sides.
  /// @pre S, or revolute joints alone.
  template <class X, class In, class Out>
  void inverse_mass_times(MassSolution<Planar, X>& solution, const In& x, Out result);

 private:
  template <class In>
  bool inward(const In& p);
  template <class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& p,
                                                PlanarArticulated<S>& a);
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
  PlanarArticulated<S> a{};
  for (std::size_t k = revolutes_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    if (!l.revolute) {
      PlanarArticulated<S> here = a;
      if (!general_inward(k, p, here)) {
        singular_joint_ = static_cast<int>(k);
        return false;
      }
      a = here;
      continue;
    }
    PlanarRevolute<S>& w = revolutes_[k];
    const S c = Base::angles_.cosine(k), s = Base::angles_.sine(k);
    const S kx = l.cx * c - l.cy * s, ky = l.cx * s + l.cy * c;
    if (l.leaf) a = {};
    Base::add_body(a, l, kx, ky);
    a.G = a.G + (l.wx * c + l.wy * s);
    if (l.slot >= 0) Base::add(a, slots_[static_cast<std::size_t>(l.slot)]);
    const S pivot = pivot_of(l, a.I);
    if (!all_positive(pivot)) {
      singular_joint_ = static_cast<int>(k);
      return false;
    }
    w.inverse = S(1.0) / pivot;
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
    if (l.has_rotor)
      Base::carry_with_rotor(a, l, w.hx, w.hy, w.inverse, w.rx, w.ry, pk - l.rotor * w.y0);
    else
      Base::carry(a, w.rx, w.ry, pk);
    if (!l.first) Base::leave(l, Base::slot_of_parent(l), a);
  }
  return true;
}

template <class S>
template <class In>
bool MomentumSweeps<Planar, S>::general_inward(std::size_t k, const In& p,
                                               PlanarArticulated<S>& a) {
  const PlanarLink& l = tree_->links[k];
  const auto& b = Base::body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  const S c = Base::angles_.cosine(k), s = Base::angles_.sine(k);
  if (l.leaf) a = {};
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
  if (b.drive >= 0) {  // M' = M*: momentum of the prescribed rates Ω_t, (44)
    Planar::Motion<S> prescribed{};
    Joint<Planar>::add_motion(b, x.edge, &x.drive_rate, prescribed);
    D += Planar::momentum(x.M, prescribed);
  }
  if (b.parent < 0) return true;
  Base::carry(a, x, M, D);
  // The subtree's weight acts at the parent wherever this joint moves.
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
  for (std::size_t k = 0; k < revolutes_.size(); ++k) {
    const PlanarLink& l = links[k];
    if (l.parent < 0) {
      vx = vy = omega = zero;
    } else if (!l.first) {
      const auto& from = Base::motion_of_parent(l);
      vx = from.vx;
      vy = from.vy;
      omega = from.omega;
    }
    if (!l.revolute) {
      PlanarMotion<S> here{vx, vy, omega};
      general_outward(k, q, u, pdot, here);
      vx = here.vx;
      vy = here.vy;
      omega = here.omega;
    } else {
      const PlanarRevolute<S>& w = revolutes_[k];
      S own = w.y0, rate = w.G, turning = w.y0;
      if (l.parent >= 0) {
        vx = vx - omega * w.ry;
        vy = vy + omega * w.rx;
        const S Px = w.Axx * vx + w.Axy * vy + w.Dx, Py = w.Axy * vx + w.Ayy * vy + w.Dy;
        rate = w.G + (vy * Px - vx * Py);
        turning = w.y0 - (w.hx * vx + w.hy * vy);
        if (l.has_rotor) {
          rate = rate + l.rotor * omega * (vy * w.hx - vx * w.hy);
          turning = turning + l.rotor * w.inverse * omega;
        }
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

}  // namespace momenta
