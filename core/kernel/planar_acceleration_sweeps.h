#pragma once
// The articulated-body recursion in a plane, (q, u, t) → u̇: with the elimination and axes of
// planar_momentum_sweeps.h. The velocity product of a revolute joint is −ω_L² r, the bias of a body
// −ω² m c.

#include <momenta/core/kernel/planar_places.h>

namespace momenta {

template <class Space, class S>
class AccelerationSweeps;

template <class S>
class AccelerationSweeps<Planar, S> : PlanarPlaces<S> {
  using Base = PlanarPlaces<S>;
  using Base::joints_, Base::outward_slots_, Base::revolutes_, Base::slots_, Base::singular_joint_,
      Base::tree_;

 public:
  using Space = Planar;
  using Base::Base, Base::singular_joint;

  /// u̇ (nv) from (q, u, t) and all generalised forces τ (nv) but weights. O(bodies).
  template <class In, class InTau, class Out>
  bool operator()(const S& t, const In& q, const In& u, const InTau& tau, Out udot) {
    Base::place(t, q);
    singular_joint_ = -1;
    velocities(u);
    if (!inward(tau)) return false;
    outward(udot);
    return true;
  }

 private:
  /// Fills the records of revolute joints: `Dx`, `Dy` = −ω² m c of the body, then c = −ω_L² r in
  /// `Axx`, `Axy`.
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
  for (std::size_t k = 0; k < revolutes_.size(); ++k) {
    const PlanarLink& l = links[k];
    if (l.parent < 0)
      omega = zero;
    else if (!l.first)
      omega = Base::motion_of_parent(l).omega;
    PlanarRevolute<S>& w = revolutes_[k];
    const S c = Base::angles_.cosine(k), s = Base::angles_.sine(k), parent_squared = omega * omega;
    if (l.revolute) {
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
  PlanarArticulated<S> a{};
  for (std::size_t k = revolutes_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    PlanarRevolute<S>& w = revolutes_[k];
    if (l.leaf) a = {};
    Base::add_body(a, l, w.kx, w.ky);
    a.Dx = a.Dx + w.Dx;
    a.Dy = a.Dy + w.Dy;
    if (l.slot >= 0) Base::add(a, slots_[static_cast<std::size_t>(l.slot)]);
    if (l.revolute) {
      const S pivot = pivot_of(l, a.I);
      if (!all_positive(pivot)) {
        singular_joint_ = static_cast<int>(k);
        return false;
      }
      w.inverse = S(1.0) / pivot;
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
      if (l.has_rotor)
        Base::carry_with_rotor(a, l, w.hx, w.hy, w.inverse, w.rx, w.ry,
                               n + l.rotor * (w.hx * w.Axx + w.hy * w.Axy - w.y0));
      else
        Base::carry(a, w.rx, w.ry, n);
    } else {
      const auto& b = Base::body(k);
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      x.M = Base::blocks(a);
      x.D = {{{a.Dx, a.Dy}}, a.Dn};
      const S r = b.nv == 1 ? S(tau[b.u]) : S(0.0);
      Planar::ArticulatedInertia<S> M;
      if (!eliminate<Planar>(b, x, M)) {
        singular_joint_ = static_cast<int>(k);
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
  for (std::size_t k = 0; k < revolutes_.size(); ++k) {
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
    if (l.revolute) {
      const PlanarRevolute<S>& w = revolutes_[k];
      if (l.parent >= 0) {
        vx = vx - alpha * w.ry + w.Axx;
        vy = vy + alpha * w.rx + w.Axy;
      }
      S turning = w.y0 - (w.hx * vx + w.hy * vy);
      if (l.has_rotor) turning = turning + l.rotor * w.inverse * alpha;
      const S own = turning - alpha;
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
