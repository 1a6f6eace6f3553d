#pragma once
// Joints on one axis, free and user joints in the momentum recursion, both sweeps.

#include <momenta/core/kernel/axis_joint.h>
#include <momenta/core/kernel/momentum_sweeps.h>

namespace momenta {

template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::axis_inward(std::size_t k, const In& p, Articulated<S>& from) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  Articulated<S> articulated{};
  if (!l.leaf) articulated = from;
  add_body<Gravity>(articulated, l);
  if (l.slot >= 0) add<Gravity>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
  if (b.nv > 0) {
    x.M = blocks(articulated.M);
    x.D = remainder_of(articulated);
    if constexpr (Gravity) x.moment = {{articulated.Gx, articulated.Gy, articulated.Gz}};
    if (!eliminate_axis(b, S(p[l.u]), articulated, x)) return false;
  } else if (b.drive >= 0) {
    const AxisColumn<S> U = axis_column(b, articulated.M);
    articulated.Dfx = articulated.Dfx + x.drive_rate * U.fx;
    articulated.Dfy = articulated.Dfy + x.drive_rate * U.fy;
    articulated.Dfz = articulated.Dfz + x.drive_rate * U.fz;
    articulated.Dnx = articulated.Dnx + x.drive_rate * U.nx;
    articulated.Dny = articulated.Dny + x.drive_rate * U.ny;
    articulated.Dnz = articulated.Dnz + x.drive_rate * U.nz;
  }
  if (l.parent < 0) return true;
  carry_axis<Gravity>(l, b.edge, x.edge, b.subtree_mass, articulated);
  from = articulated;
  if (!l.first) leave<Gravity>(l, slot_of_parent(l), from);
  return true;
}

template <class S>
template <bool Gravity, class In, class Out>
void MomentumSweeps<Spatial, S>::axis_outward(std::size_t k, const In& q, Out u, Out pdot,
                                              OutwardMotion<S>& c) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  const auto& x = joints_[static_cast<std::size_t>(l.record)];
  const S zero(0.0);
  OutwardMotion<S> w = c;
  if (l.parent < 0) {
    const auto& g = tree_->model->gravity;
    w = {zero, zero, zero, zero, zero, zero, S(g[0]), S(g[1]), S(g[2])};
  }
  constants_and_screw_outward<Gravity>(l, b.edge, x.edge, w);
  if (b.nv == 0) {
    add_axis_motion(b, x.drive_rate, w);
  } else {
    const S own = axis_rate(x, w);
    add_axis_motion(b, own, w);
    S rate = axis_momentum_rate<Gravity>(b, x, w);
    if (l.has_force) rate = rate + joint_force(b, S(q[l.q]), own);
    u[l.u] = own;
    pdot[l.u] = rate;
  }
  c = w;
}

template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::general_inward(std::size_t k, const In& p,
                                                Articulated<S>& articulated) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  if (l.leaf) articulated = {};
  add_body<true>(articulated, l);
  if (l.slot >= 0) add<Gravity>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
  x.M = blocks(articulated.M);
  x.D = remainder_of(articulated);
  x.moment = {{articulated.Gx, articulated.Gy, articulated.Gz}};
  S r[6]{};
  for (int i = 0; i < b.nv; ++i) r[i] = p[b.u + i];
  Spatial::ArticulatedInertia<S> M;
  if (!eliminate<Spatial>(b, x, M)) return false;
  auto D = remainder<Spatial>(b, x, r);
  if (b.law) D += reduced_momentum<Spatial>(b, x, x.user->motion.drift);
  if (b.parent < 0) {
    x.h = D;
    return true;
  }
  Vec3<S> G{};
  if constexpr (Gravity)
    G = Spatial::moment_to_parent(b.edge, b.kind, x.edge, x.moment, b.subtree_mass);
  set_articulated(articulated, Spatial::to_parent(b.edge, b.kind, x.edge, M),
                  Spatial::to_parent(b.edge, b.kind, x.edge, D), G);
  if (!l.first) leave<Gravity>(l, slot_of_parent(l), articulated);
  return true;
}

template <class S>
template <bool Gravity, class In, class Out>
void MomentumSweeps<Spatial, S>::general_outward(std::size_t k, const In& q, Out u, Out pdot,
                                                 OutwardMotion<S>& c) {
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
  if (b.law) V += x.user->motion.drift;
  if (b.nv > 0) {
    S own[6];
    solve_joint<Spatial>(b, x, V, own);
    Spatial::Force<S> net{};
    if constexpr (Gravity) net = Spatial::weight(S(b.subtree_mass), x.moment, g);
    Spatial::Force<S> P;
    if (b.kind == JointKind::free && b.parent < 0) {
      P = x.h;  // all of P*
    } else {
      P = Spatial::momentum(x.M, V);  // (42)
      P += x.D;
    }
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
  set_articulated(c, V, g);
}

}  // namespace momenta
