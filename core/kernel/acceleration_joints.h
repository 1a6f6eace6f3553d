#pragma once
// Joints other than revolute in the articulated recursion, inward and outward: spherical, on one
// axis, free, user.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/axis_joint.h>

namespace momenta {

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::spherical_inward(std::size_t k, const InTau& tau,
                                                      Articulated<S>& articulated) {
  const Link& l = tree_->links[k];
  SphericalAcceleration<S>& w = sphericals_[static_cast<std::size_t>(l.record)];
  const Vec3<S> forces{{S(tau[l.u]), S(tau[l.u + 1]), S(tau[l.u + 2])}};
  Vec3<S> e = forces - w.bn, f = w.bf;
  if (!w.constant) {
    if (l.leaf) articulated = {};
    add_body(articulated.M, l);
    if (l.slot >= 0) add<false>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
    if (!w.pivot.eliminate(articulated.M, w.A)) return false;
    e -= Vec3<S>{{articulated.Dnx, articulated.Dny, articulated.Dnz}};
    f += Vec3<S>{{articulated.Dfx, articulated.Dfy, articulated.Dfz}};
  }
  f += w.pivot.remainder(e);
  if (l.parent < 0) return true;
  f += w.A * w.cl;
  carry_spherical(tree_->sphericals[static_cast<std::size_t>(l.record)].origin, w.R, w.A, f, forces,
                  articulated);
  if (!l.first) leave<false>(l, slot_of_parent(l), articulated);
  return true;
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::axis_inward(std::size_t k, const InTau& tau,
                                                 Articulated<S>& from) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  Articulated<S> articulated{};
  if (!l.leaf) articulated = from;
  add_body(articulated.M, l);
  add_remainder(articulated, x.D);
  if (l.slot >= 0) add<false>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
  if (b.nv > 0 && !eliminate_axis(b, S(tau[l.u]), articulated, x)) return false;
  if (l.parent < 0) return true;
  const Full<S>& m = articulated.M;
  const Vec3<S>&v = x.c.v, &w = x.c.w;
  articulated.Dfx = articulated.Dfx + (m.Axx * v[0] + m.Axy * v[1] + m.Axz * v[2] + m.Hxx * w[0] +
                                       m.Hxy * w[1] + m.Hxz * w[2]);
  articulated.Dfy = articulated.Dfy + (m.Axy * v[0] + m.Ayy * v[1] + m.Ayz * v[2] + m.Hyx * w[0] +
                                       m.Hyy * w[1] + m.Hyz * w[2]);
  articulated.Dfz = articulated.Dfz + (m.Axz * v[0] + m.Ayz * v[1] + m.Azz * v[2] + m.Hzx * w[0] +
                                       m.Hzy * w[1] + m.Hzz * w[2]);
  articulated.Dnx = articulated.Dnx + (m.Hxx * v[0] + m.Hyx * v[1] + m.Hzx * v[2] + m.Ixx * w[0] +
                                       m.Ixy * w[1] + m.Ixz * w[2]);
  articulated.Dny = articulated.Dny + (m.Hxy * v[0] + m.Hyy * v[1] + m.Hzy * v[2] + m.Ixy * w[0] +
                                       m.Iyy * w[1] + m.Iyz * w[2]);
  articulated.Dnz = articulated.Dnz + (m.Hxz * v[0] + m.Hyz * v[1] + m.Hzz * v[2] + m.Ixz * w[0] +
                                       m.Iyz * w[1] + m.Izz * w[2]);
  carry_axis<false>(l, b.edge, x.edge, 0, articulated);
  from = articulated;
  if (!l.first) leave<false>(l, slot_of_parent(l), from);
  return true;
}

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::general_inward(std::size_t k, const InTau& tau,
                                                    Articulated<S>& articulated) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  if (l.leaf) articulated = {};
  add_body(articulated.M, l);
  if (l.slot >= 0) add<false>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
  x.M = blocks(articulated.M);
  x.D += remainder_of(articulated);
  S forces[6]{};
  for (int i = 0; i < b.nv; ++i) forces[i] = S(tau[b.u + i]);
  Spatial::ArticulatedInertia<S> M;
  if (!eliminate<Spatial>(b, x, M)) return false;
  auto D = remainder<Spatial>(b, x, forces);
  if (b.parent < 0) return true;
  D += reduced_momentum<Spatial>(b, x, x.c);
  set_articulated(articulated, Spatial::to_parent(b.edge, b.kind, x.edge, M),
                  Spatial::to_parent(b.edge, b.kind, x.edge, D), Vec3<S>{});
  if (!l.first) leave<false>(l, slot_of_parent(l), articulated);
  return true;
}

template <class S>
template <class Out>
void AccelerationSweeps<Spatial, S>::axis_outward(std::size_t k, Out udot, OutwardMotion<S>& c) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  const auto& x = joints_[static_cast<std::size_t>(l.record)];
  OutwardMotion<S> w = c;
  constants_and_screw_outward<false>(l, b.edge, x.edge, w);
  add_motion(w, x.c);
  if (b.nv > 0) {
    const S own = axis_rate(x, w);
    add_axis_motion(b, own, w);
    udot[l.u] = own;
  }
  c = w;
}

template <class S>
template <class Out>
void AccelerationSweeps<Spatial, S>::general_outward(std::size_t k, Out udot, OutwardMotion<S>& c) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  Spatial::Motion<S> V{{{c.vx, c.vy, c.vz}}, {{c.ox, c.oy, c.oz}}};
  if (l.kind == LinkKind::spherical) {
    const auto& w = sphericals_[static_cast<std::size_t>(l.record)];
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
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
  set_articulated(c, V, Vec3<S>{});
}

}  // namespace momenta
