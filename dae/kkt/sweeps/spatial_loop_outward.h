#pragma once
// The outward sweep in space, and the last one inward for ṗ. Part of spatial_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

/// Impulses of the loops in `range`, last closed first; `motion` null at the ground.
template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::solve_loops(const LoopPlan::Range& range,
                                                             const RightSide<S>& right,
                                                             const Motion* motion, Column& sigma,
                                                             Out& out) {
  for (int i = range.last; i-- > range.first;) {
    const auto at = static_cast<std::size_t>(plan_->closings[static_cast<std::size_t>(i)]);
    const Loop& l = loops_->loops[at];
    for (int j = l.rows; j-- > 0;) {
      const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
      const S x = motion ? row.impulse(*motion, sigma) : row.impulse_at_ground(sigma);
      sigma.set(row.slot, x);
      const int place = l.row + row.slot - plan_->slot[at];
      out[place] = right.centre ? x + right.centre[place] : x;
    }
  }
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In, class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::outward(const In& q, const RightSide<S>& right,
                                                         Out u, Out impulse, Out rate) {
  const auto* links = tree_->links.data();
  const bool rates = Momentum && right.rates;
  const auto& gravity = tree_->model->gravity;
  Moving m{};
  Column at_ground{};
  for (std::size_t k = 0; k < swept_; ++k) {
    if (elsewhere(k)) continue;
    const auto& l = links[k];
    if (l.parent < 0) {
      m.V = {};
      for (int i = 0; i < 3; ++i) m.g[i] = S(gravity[i]);
      if (const int onto = plan_->folded_onto[k]; onto >= 0) {
        m.sigma = {};
        solve_loops(plan_->gathered_closings_of[k], right, &taken_[static_cast<std::size_t>(onto)],
                    m.sigma, impulse);
      } else {
        solve_loops(plan_->gathered_closings_of[k], right, nullptr, at_ground, impulse);
        m.sigma = at_ground;
      }
    } else if (!l.first) {
      Moving& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      const LoopPlan::Range closed = plan_->gathered_closings_of[k];
      if (closed.first != closed.last) solve_loops(closed, right, &from.V, from.sigma, impulse);
      m = from;
    }
    if (l.kind == LinkKind::revolute)
      revolute_outward(k, q, rates, m, u, rate);
    else if (of_looped_branches || l.one_axis)
      axis_outward(k, q, rates, m, u, rate);
    else if constexpr (!of_looped_branches) {
      if (l.kind == LinkKind::spherical)
        spherical_outward(k, rates, m, u, rate);
      else if (body(k).law)
        user_outward(k, rates, m, u, rate);
      else
        free_outward(k, rates, m, u, rate);
    }
    const LoopPlan::Range closed = plan_->closings_of[k];
    if (closed.first != closed.last) solve_loops(closed, right, &m.V, m.sigma, impulse);
    if (plan_->takes_branches[k]) taken_[k] = m.V;
    if constexpr (Momentum)
      if (rates) set_velocity(k, m.V);
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = m;
  }
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In, class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::revolute_outward(std::size_t k, const In& q,
                                                                  bool rates, Moving& m, Out u,
                                                                  Out rate) {
  const auto& l = tree_->links[k];
  const RevoluteRecord& w = revolutes_[k];
  Vec3<S>&v = m.V.v, &o = m.V.w;
  const S c = angles_.cosine(k), s = angles_.sine(k);
  const auto along = [&](const Column& x) MOMENTA_INLINED { return along_sigma(k, x, m.sigma); };
  S turned(0.0);
  const bool falls = Momentum && rates && tree_->model->has_gravity;
  if (l.parent >= 0) {
    constants_outward(l, body(k).edge, v[0], v[1], v[2], o[0], o[1], o[2]);
    if constexpr (!Momentum) m.V += w.c;
    if (falls) constants_outward(l, body(k).edge, m.g[0], m.g[1], m.g[2]);
    v[0] = v[0] + l.d * o[1];
    v[1] = v[1] - l.d * o[0];
  } else {
    m.V = {};
    if constexpr (!Momentum) m.V = w.c;
    if (falls) {
      const auto& g = tree_->weight[k];
      m.g = {{S(g[0]), S(g[1]), S(g[2])}};
    }
  }
  momenta::turn_back<2>(v, c, s);
  momenta::turn_back<2>(o, c, s);
  if (rates && l.parent >= 0)
    turned = turning_rate(w.M, w.Dfx, w.Dfy, w.Dnx, w.Dny, v[0], v[1], v[2], o[0], o[1]) +
             turning_along(k, w.C, v, o, m.sigma);
  if (falls) {
    momenta::turn_back<2>(m.g, c, s);
    turned = turned + (w.Gx * m.g[1] - w.Gy * m.g[0]);
  }
  S turning = w.y0 - along(w.g) -
              (w.h.fx * v[0] + w.h.fy * v[1] + w.h.fz * v[2] + w.h.nx * o[0] + w.h.ny * o[1]);
  if (l.has_rotor) {
    if (rates) turned = turned + rotor_rate(w.h, l.rotor, v[0], v[1], o[0], o[1], o[2]);
    turning = turning + l.rotor * w.inverse * o[2];
  }
  const S own = turning - o[2];
  o[2] = turning;
  u[l.u] = own;
  if (rates) rate[l.u] = l.has_force ? turned + joint_force(body(k), S(q[l.q]), own) : turned;
}

template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::spherical_outward(std::size_t k, bool rates,
                                                                   Moving& m, Out u, Out rate) {
  const auto& l = tree_->links[k];
  const SphericalRecord& w = sphericals_[static_cast<std::size_t>(l.record)];
  Vec3<S>&v = m.V.v, &o = m.V.w;
  const auto along_slots = [&](const Column& x)
                               MOMENTA_INLINED { return along_sigma(k, x, m.sigma); };
  if (l.parent >= 0) {
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
    v = transpose_times(w.R, v + cross(o, Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}}));
    o = transpose_times(w.R, o);
  }
  if constexpr (!Momentum) m.V += w.c;
  m.g = transpose_times(w.R, m.g);
  // ω = L⁻ᵀ (Δ⁻¹ L⁻¹ e − (Z Δ⁻¹)ᵀ v − g σ)
  const Vec3<S> along = transpose_times(w.pivot.s, v);
  const S z = w.pivot.e[2] * w.pivot.i2 - along[2] - along_slots(w.g[2]);
  const S y = w.pivot.e[1] * w.pivot.i1 - along[1] - along_slots(w.g[1]) - w.pivot.l21 * z;
  const Vec3<S> omega{{w.pivot.e[0] * w.pivot.i0 - along[0] - along_slots(w.g[0]) -
                           w.pivot.l10 * y - w.pivot.l20 * z,
                       y, z}};
  Vec3<S> net{};
  if (rates) {
    Vec3<S> P = w.A * v + w.Df;
    for (int i = 0; i < 3; ++i) P[i] += along_slots(w.C[i]);
    net = cross(w.G, m.g) - cross(v, P) - cross(omega, w.p);
  }
  for (int i = 0; i < 3; ++i) {
    u[l.u + i] = omega[i] - o[i];
    if (rates) rate[l.u + i] = net[i];
  }
  o = omega;
}

template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::free_outward(std::size_t k, bool rates, Moving& m,
                                                              Out u, Out rate) {
  const auto& b = body(k);
  const auto record = static_cast<std::size_t>(tree_->links[k].record);
  const auto& x = joints_[record];
  const auto& y = any_[record];
  const auto along = [&](const Column& c) MOMENTA_INLINED { return along_sigma(k, c, m.sigma); };
  if (b.parent >= 0) m.V = Spatial::to_child(b.edge, b.kind, x.edge, m.V);
  m.g = Spatial::direction_to_child(b.edge, b.kind, x.edge, m.g);
  m.V += y.given;
  if (b.nv == 3) {
    Vec3<S> own = x.x - transpose_times(x.H, m.V.v) - x.I * (x.M.I * m.V.w);
    for (int i = 0; i < 3; ++i) u[b.u + i] = own[i] = own[i] - along(y.g[i]);
    m.V.w += own;
    if (rates) axes_rates(k, m, rate);
    return;
  }
  Vec3<S> v = x.A * x.y;
  for (int i = 0; i < 3; ++i) v[i] -= along(y.g[i]);
  Vec3<S> omega = x.x - transpose_times(x.H, v);
  for (int i = 0; i < 3; ++i) omega[i] -= along(y.g[3 + i]);
  for (int i = 0; i < 3; ++i) {
    u[b.u + i] = v[i] - m.V.v[i];
    u[b.u + 3 + i] = omega[i] - m.V.w[i];
  }
  m.V = {v, omega};
  if (rates) axes_rates(k, m, rate);
}

/// The weight less Ω × P* of (35), and P* with the impulses of the loops below.
template <class S, int Rows, bool Momentum, class Tree>
auto SpatialLoopSweeps<S, Rows, Momentum, Tree>::net_wrench(std::size_t k, const Moving& m,
                                                            Force& P) const -> Force {
  const auto& b = body(k);
  const auto record = static_cast<std::size_t>(tree_->links[k].record);
  const auto& x = joints_[record];
  Force net = Spatial::weight(S(b.subtree_mass), x.moment, m.g);
  P = Spatial::momentum(x.M, m.V);  // (42)
  P += x.D;
  for (int i = 0; i < 6; ++i) P[i] += along_sigma(k, any_[record].C[i], m.sigma);
  net -= Spatial::cross_force(m.V, P);
  return net;
}

/// (35) with E = 1 or, of spherical joints, its angular half.
template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::axes_rates(std::size_t k, const Moving& m,
                                                            Out rate) const {
  const auto& b = body(k);
  Force P;
  const Force net = net_wrench(k, m, P);
  for (int i = 0; i < b.nv; ++i) rate[b.u + i] = net[6 - b.nv + i];
}

/// ṗ += Eᵀ T*: N − κ w of the loops below, in the axes of poses, where wrenches pass from O to O by
/// a shift alone.
template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::rates_inward(const RightSide<S>& right,
                                                              const Out& impulse, Out rate) {
  for (std::size_t k = 0; k < swept_; ++k)
    if (plan_->posed[k] != OnWay::no) wrenches_[k] = {};
  if constexpr (takes_packs)
    if (branches_apart_)
      for (auto& pack : packs_) {
        const auto onto = static_cast<std::size_t>(pack->onto());
        pack->inertial_rates(bodies_[onto], wrenches_[onto], rate);
      }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (loop_elsewhere(i)) continue;
    const Loop& l = loops_->loops[i];
    if (l.is_coupler()) continue;
    const SpatialLoopPlace<S>& s = places_[i];
    Vec3<S> force, couple;
    s.inertial_rate(
        l, motion_of(l, s), [&](int row) { return S(impulse[l.row + row]); }, right.leak, force,
        couple);
    if (l.a >= 0) wrenches_[static_cast<std::size_t>(l.a)] += {force, couple + cross(s.ra, force)};
    if (l.b >= 0) wrenches_[static_cast<std::size_t>(l.b)] -= {force, couple + cross(s.rb, force)};
  }
  for (std::size_t k = swept_; k-- > 0;) {
    if (plan_->posed[k] != OnWay::moved || elsewhere(k)) continue;
    const auto& l = tree_->links[k];
    const auto& b = body(k);
    const auto& axes = bodies_[k].pose.axes;
    const Force& T = wrenches_[k];
    const auto about_z = [&](const Vec3<S>& x) {
      return axes(0, 2) * x[0] + axes(1, 2) * x[1] + axes(2, 2) * x[2];
    };
    if (l.kind == LinkKind::revolute) {
      rate[l.u] = S(rate[l.u]) + about_z(T.n);
    } else if (l.kind == LinkKind::spherical) {
      const Vec3<S> n = transpose_times(axes, T.n);
      for (int i = 0; i < 3; ++i) rate[l.u + i] = S(rate[l.u + i]) + n[i];
    } else if (b.kind == JointKind::prismatic && b.nv > 0) {
      rate[b.u] = S(rate[b.u]) + about_z(T.f);
    } else if constexpr (!of_looped_branches) {
      if (b.nv > 0) {
        S along[6];
        Joint<Spatial>::project(b, joints_[static_cast<std::size_t>(l.record)].edge,
                                Force{transpose_times(axes, T.f), transpose_times(axes, T.n)},
                                along);
        for (int i = 0; i < b.nv; ++i) rate[b.u + i] = S(rate[b.u + i]) + along[i];
      }
    }
    if (l.parent >= 0)
      wrenches_[static_cast<std::size_t>(l.parent)] += {T.f, T.n + cross(bodies_[k].step, T.f)};
  }
  if constexpr (!of_looped_branches)
    if (plan_->couples() && right.leak != 0)
      leak_of_couplers<S>(*loops_, right.leak, impulse, rate);
}

template <class S, int Rows, bool Momentum, class Tree>
template <class Report>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::each_row(Report&& report) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (loop_elsewhere(i)) continue;
    const Loop& l = loops_->loops[i];
    for (int j = 0; j < l.rows; ++j) {
      const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
      report(l.row + row.slot - plan_->slot[i], row.w, row.tau);
    }
  }
}

template <class S, int Rows, bool Momentum, class Tree>
template <class Report>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::each_pivot(Report&& report) const {
  each_row([&](int row, const S& w, const S& tau) { report(row, value_of(w), value_of(tau)); });
  if constexpr (takes_packs)
    if (branches_apart_)
      for (const auto& pack : packs_) pack->each_pivot(report);
}

}  // namespace momenta
