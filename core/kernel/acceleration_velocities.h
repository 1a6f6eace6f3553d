#pragma once
// First sweep of the articulated recursion: angular velocities outward, c and bias wrenches.

#include <momenta/core/kernel/acceleration_sweeps.h>

namespace momenta {

/// ω × (ω × m c) and ω × J ω of a body.
template <class Link, class S>
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

/// ω and c of a revolute joint from the parent's ω, before its screw; p = ω × (ω × r) of its
/// origin.
template <class Link, class S>
MOMENTA_INLINE void turn_velocity(const Link& l, const S& px, const S& py, const S& pz,
                                  const S& own, const S& c, const S& s, S& ox, S& oy, S& oz,
                                  RevoluteAcceleration<S>& w) {
  const S wz = oz + own, dx = l.d * ox, dy = l.d * oy;
  w.clx = px + dx * wz;
  w.cly = py + dy * wz;
  w.clz = pz - (dx * ox + dy * oy);
  w.cox = oy * own;
  w.coy = -(ox * own);
  turn_outward(c, s, ox, oy);
  oz = wz;
}
/// The same from the parent's frame, over a turn and shift about x alone.
template <class Link, class Edge, class S>
MOMENTA_INLINE void revolute_velocity(const Link& l, const Edge& edge, const S& own, const S& c,
                                      const S& s, S& ox, S& oy, S& oz, RevoluteAcceleration<S>& w) {
  const S yy = oy * oy, zz = oz * oz;
  S px = -(l.a * (yy + zz)), py = l.a * (ox * oy), pz = l.a * (ox * oz);
  constants_outward(l, edge, ox, oy, oz);
  constants_outward(l, edge, px, py, pz);
  turn_velocity(l, px, py, pz, own, c, s, ox, oy, oz, w);
}
/// The same over any constant screws.
template <class Link, class Edge, class S>
MOMENTA_INLINE void screwed_revolute_velocity(const Link& l, const Edge& edge, const S& own,
                                              const S& c, const S& s, S& ox, S& oy, S& oz,
                                              RevoluteAcceleration<S>& w) {
  Spatial::Motion<S> W{{}, {{ox, oy, oz}}};
  Spatial::constants_outward(edge, W);
  const Vec3<S> p = cross(W.w, W.v);
  ox = W.w[0];
  oy = W.w[1];
  oz = W.w[2];
  turn_velocity(l, p[0], p[1], p[2], own, c, s, ox, oy, oz, w);
}

template <class S>
template <class In>
void AccelerationSweeps<Spatial, S>::velocities(const In& u) {
  const Link* links = tree_->links.data();
  const S zero(0.0);
  S ox = zero, oy = zero, oz = zero;
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Link& l = links[k];
    if (l.parent >= 0 && !l.first) {
      const auto& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
    }
    if (l.kind != LinkKind::revolute || l.screwed || l.turn == Turn::tilted) {
      OutwardMotion<S> here{zero, zero, zero, ox, oy, oz, zero, zero, zero};
      any_velocity(k, u, here);
      ox = here.ox;
      oy = here.oy;
      oz = here.oz;
    } else {
      RevoluteAcceleration<S>& w = revolutes_[k];
      const S own = u[l.u];
      if (l.parent < 0) {
        ox = oy = zero;
        oz = own;
      } else {
        revolute_velocity(l, body(k).edge, own, angles_.cosine(k), angles_.sine(k), ox, oy, oz, w);
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
                                                  OutwardMotion<S>& articulated) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  // The parent's rotation seen from the child: ω, and the velocity ω × r of the child's origin.
  Spatial::Motion<S> W{{}, {{articulated.ox, articulated.oy, articulated.oz}}};
  if (l.parent < 0) W = {};
  Vec3<S> omega;
  if (l.kind == LinkKind::revolute) {
    auto& w = revolutes_[k];
    omega = W.w;
    const S own = u[l.u];
    if (l.parent >= 0)
      screwed_revolute_velocity(l, b.edge, own, angles_.cosine(k), angles_.sine(k), omega[0],
                                omega[1], omega[2], w);
    else
      omega[2] += own;
    bias_wrench(l, omega[0], omega[1], omega[2], w.bfx, w.bfy, w.bfz, w.bnx, w.bny, w.bnz);
  } else if (l.kind == LinkKind::spherical) {
    auto& w = sphericals_[static_cast<std::size_t>(l.record)];
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
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
  articulated.ox = omega[0];
  articulated.oy = omega[1];
  articulated.oz = omega[2];
}

}  // namespace momenta
