#pragma once
// The first sweep of the articulated recursion: angular velocities outward, c and bias wrenches.

#include <momenta/core/kernel/acceleration_sweeps.h>

namespace momenta {

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

}  // namespace momenta
