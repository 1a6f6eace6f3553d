#pragma once
// Joints eliminated on the way inward in space: revolute joints, spherical joints with a rotor or
// without, free ones; others on one axis are in spatial_loop_axes.h. Part of spatial_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::revolute_inward(std::size_t k, const In& r,
                                                                 const RightSide<S>& right,
                                                                 Carried& a) {
  const auto& l = tree_->links[k];
  RevoluteRecord& w = revolutes_[k];
  Articulated<S>& m = a.articulated;
  Blocks& o = a.blocks;
  const S pivot = pivot_of(l, m.M.Izz);
  if (!all_positive(pivot)) return false;
  const bool couples = plan_->couples();
  S own = S(r[l.u]);
  if (couples) {
    each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int slot) {
      o.C[5].add(slot, S(j.ratio));
      if (j.first) o.d.add(slot, coupled_[loop]);
      if (right.centre) own = own - j.ratio * right.centre[loops_->loops[loop].row];
    });
  }
  const S inverse = S(1.0) / pivot, e = own - m.Dnz;
  w.y0 = e * inverse;
  w.inverse = inverse;
  Eliminated<S> left;
  eliminate_revolute(m.M, inverse, w.h, left.M);
  left.fx = m.Dfx + w.h.fx * e;
  left.fy = m.Dfy + w.h.fy * e;
  left.fz = m.Dfz + w.h.fz * e;
  left.nx = m.Dnx + w.h.nx * e;
  left.ny = m.Dny + w.h.ny * e;
  left.nz = l.has_rotor ? own - l.rotor * w.y0 : own;
  left.Gx = w.Gx = m.Gx;
  left.Gy = w.Gy = m.Gy;
  left.Gz = m.Gz;
  if constexpr (!Momentum)
    if (l.parent < 0) {  // on the ground c is its fall
      const auto& g = tree_->weight[k];
      w.c = {{{S(-g[0]), S(-g[1]), S(-g[2])}}, {}};
    }
  const S cosine = angles_.cosine(k), sine = angles_.sine(k);
  const auto& edge = body(k).edge;
  const SlotGroups open = open_slots_.fronts[k].open;
  if (open) {
    o.eliminate(o.C[5], inverse, w.y0, open, 0, w.g);
    Column couplers{};
    if (couples)
      each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t, int slot) {
        couplers.add(slot, S(-j.ratio));
      });
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
      using Part = typename Column::Part;
      Part C[6];
      each<6>([&](auto j) MOMENTA_INLINED { C[j] = o.C[j].v[i]; });
      const Part c = C[5];
      o.scale.v[i] = o.scale.v[i] + (C[3] * C[3] + C[4] * C[4] + c * c) * Column::all(inverse);
      C[0] = C[0] - c * Column::all(w.h.fx);
      C[1] = C[1] - c * Column::all(w.h.fy);
      C[2] = C[2] - c * Column::all(w.h.fz);
      C[3] = C[3] - c * Column::all(w.h.nx);
      C[4] = C[4] - c * Column::all(w.h.ny);
      C[5] = couplers.v[i];
      if (l.has_rotor) C[5] = C[5] + c * Column::all(l.rotor * inverse);
      if constexpr (Momentum) {
        w.C[0].v[i] = C[0];
        w.C[1].v[i] = C[1];
        w.C[2].v[i] = C[3];
        w.C[3].v[i] = C[4];
      }
      screw_columns<2>(C, Column::all(cosine), Column::all(sine), Part(l.d));
      if constexpr (!Momentum) {
        // d' += C'ᵀ c
        const Motion& given = w.c;
        o.d.v[i] = o.d.v[i] + (C[0] * Column::all(given.v[0]) + C[1] * Column::all(given.v[1]) +
                               C[2] * Column::all(given.v[2]) + C[3] * Column::all(given.w[0]) +
                               C[4] * Column::all(given.w[1]));
      }
      if (l.parent >= 0) {
        columns_to_parent(l, edge, C);
        each<6>([&](auto j) MOMENTA_INLINED { o.C[j].v[i] = C[j]; });
      }
    });
  }
  w.M = turning_of(left.M);
  if constexpr (Momentum) {
    w.Dfx = left.fx;
    w.Dfy = left.fy;
    w.Dnx = left.nx;
    w.Dny = left.ny;
    if (l.parent < 0) return true;
  }
  // The revolute joint's screw.
  turn_and_shift_z(left.M, w.M, cosine, sine, l.d);
  S x = cosine * left.fx - sine * left.fy;
  left.fy = sine * left.fx + cosine * left.fy;
  left.fx = x;
  x = cosine * left.nx - sine * left.ny;
  left.ny = sine * left.nx + cosine * left.ny + l.d * left.fx;
  left.nx = x - l.d * left.fy;
  x = cosine * left.Gx - sine * left.Gy;
  left.Gy = sine * left.Gx + cosine * left.Gy;
  left.Gx = x;
  Force column;
  if (l.has_rotor) column = turned_rotor(l, w.h, inverse, cosine, sine);
  if constexpr (!Momentum) {
    // D' += M'c
    const Reduced<S>& M = left.M;
    const Vec3<S>&v = w.c.v, &n = w.c.w;
    left.fx += M.Axx * v[0] + M.Axy * v[1] + M.Axz * v[2] + M.Hxx * n[0] + M.Hxy * n[1];
    left.fy += M.Axy * v[0] + M.Ayy * v[1] + M.Ayz * v[2] + M.Hyx * n[0] + M.Hyy * n[1];
    left.fz += M.Axz * v[0] + M.Ayz * v[1] + M.Azz * v[2] + M.Hzx * n[0] + M.Hzy * n[1];
    left.nx += M.Hxx * v[0] + M.Hyx * v[1] + M.Hzx * v[2] + M.Ixx * n[0] + M.Ixy * n[1];
    left.ny += M.Hxy * v[0] + M.Hyy * v[1] + M.Hzy * v[2] + M.Ixy * n[0] + M.Iyy * n[1];
    if (l.has_rotor) left.nz += Spatial::power(column, w.c);
    if (l.parent < 0) return true;
  }
  carry_any<Momentum>(l, edge, left, m);
  if (l.has_rotor) carry_rotor_of(l, edge, column, m);
  return true;
}

/// L⁻¹ c, then as three revolute joints; `step`: to the joint, in the parent's axes.
template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::spherical_columns_inward(SphericalRecord& w,
                                                                          const Vec3<S>& step,
                                                                          SlotGroups open,
                                                                          Blocks& o) {
  const auto times = [](const auto& part, const S& x)
                         MOMENTA_INLINED { return part * Column::all(x); };
  Column z[3];
  each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
    z[0].v[i] = o.C[3].v[i];
    z[1].v[i] = o.C[4].v[i] - times(z[0].v[i], w.pivot.l10);
    z[2].v[i] = o.C[5].v[i] - times(z[0].v[i], w.pivot.l20) - times(z[1].v[i], w.pivot.l21);
  });
  const S inverse[3] = {w.pivot.i0, w.pivot.i1, w.pivot.i2};
  for (int j = 0; j < 3; ++j)
    o.eliminate(z[j], inverse[j], inverse[j] * w.pivot.e[j], open, 0, w.g[j]);
  each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
    typename Column::Part C[6];
    for (int j = 0; j < 3; ++j) {
      const auto zj = z[j].v[i];
      o.scale.v[i] = o.scale.v[i] + zj * w.g[j].v[i];
    }
    for (int j = 0; j < 3; ++j) {
      C[j] = o.C[j].v[i] - (times(z[0].v[i], w.pivot.s(j, 0)) + times(z[1].v[i], w.pivot.s(j, 1)) +
                            times(z[2].v[i], w.pivot.s(j, 2)));
      w.C[j].v[i] = C[j];
      C[3 + j] = typename Column::Part(0.0);
      if constexpr (!Momentum) o.d.v[i] = o.d.v[i] + times(C[j], w.c.v[j]);
    }
    columns_to_parent<Column>(w.R, step, C);
    each<6>([&](auto j) MOMENTA_INLINED { o.C[j].v[i] = C[j]; });
  });
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::spherical_inward(std::size_t k, const In& r,
                                                                  Carried& a) {
  const auto& l = tree_->links[k];
  const auto record = static_cast<std::size_t>(l.record);
  SphericalRecord& w = sphericals_[record];
  Articulated<S>& m = a.articulated;
  w.p = {{S(r[l.u]), S(r[l.u + 1]), S(r[l.u + 2])}};
  if (!w.pivot.eliminate(m.M, w.A)) return false;
  w.G = {{m.Gx, m.Gy, m.Gz}};
  w.Df = Vec3<S>{{m.Dfx, m.Dfy, m.Dfz}} + w.pivot.remainder(w.p - Vec3<S>{{m.Dnx, m.Dny, m.Dnz}});
  if constexpr (!Momentum)
    if (l.parent < 0) {
      const auto& g = tree_->model->gravity;
      w.c.v = transpose_times(w.R, Vec3<S>{{S(-g[0]), S(-g[1]), S(-g[2])}});
    }
  const auto& at = tree_->sphericals[record].origin;
  if (const SlotGroups open = open_slots_.fronts[k].open)
    spherical_columns_inward(w, {{S(at[0]), S(at[1]), S(at[2])}}, open, a.blocks);
  Vec3<S> force = w.Df;
  if constexpr (!Momentum) force += w.A * w.c.v;
  if (l.parent < 0) return true;
  carry_spherical(at, w.R, w.A, force, w.p, m);
  if constexpr (Momentum) {
    const Vec3<S> G = w.R * w.G;
    m.Gx = G[0];
    m.Gy = G[1];
    m.Gz = G[2];
  }
  return true;
}

/// Common inward part of joints without one axis: the record of body k with its open columns, its
/// own momenta (forces) `own` and, of the tree alone, M' and D'. At the ground gravity becomes a
/// given acceleration.
template <class S, int Rows, bool Momentum, class Tree>
template <class In>
MOMENTA_INLINE bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::tree_inward(
    std::size_t k, const In& r, Carried& a, S* own, Spatial::ArticulatedInertia<S>& M, Force& D) {
  const auto& b = body(k);
  const auto record = static_cast<std::size_t>(tree_->links[k].record);
  auto& x = joints_[record];
  auto& y = any_[record];
  Blocks& o = a.blocks;
  const SlotGroups open = open_slots_.fronts[k].open;
  o.begin(false, ~open);
  x.M = blocks(a.articulated.M);
  x.D = remainder_of(a.articulated);
  x.moment = {{a.articulated.Gx, a.articulated.Gy, a.articulated.Gz}};
  if (open)
    for (int i = 0; i < 6; ++i) y.C[i] = o.C[i];
  for (int i = 0; i < b.nv; ++i) own[i] = S(r[b.u + i]);
  if (!eliminate<Spatial>(b, x, M)) return false;
  D = remainder<Spatial>(b, x, own);
  if constexpr (!Momentum)
    if (b.parent < 0) {
      const auto& g = tree_->model->gravity;
      y.given.v -=
          Spatial::direction_to_child(b.edge, b.kind, x.edge, Vec3<S>{{S(g[0]), S(g[1]), S(g[2])}});
    }
  return true;
}

/// Free joints: nothing is left of a body, M' = 0, C' = 0, and D' is its own p. Spherical joints
/// with a rotor, J = I + I_r 1 (general_joint.h): g = J⁻¹ C_n, C' = (C_f − H g, I_r g), and M' ≠ 0
/// goes to the parent with D'.
template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::free_inward(std::size_t k, const In& r,
                                                             Carried& a) {
  const auto& b = body(k);
  const auto record = static_cast<std::size_t>(tree_->links[k].record);
  auto& x = joints_[record];
  auto& y = any_[record];
  Blocks& o = a.blocks;
  const SlotGroups open = open_slots_.fronts[k].open;
  S own[6];
  Spatial::ArticulatedInertia<S> M;
  Force D;
  if (!tree_inward(k, r, a, own, M, D)) return false;
  const auto eliminate_slots = [&](const Column& c, const Column& g, const S& e) {
    o.d += g * e;
    o.scale += c * g;
    o.add_product(g, c, open);
  };
  if (!open) {
    if constexpr (!Momentum)
      if (b.nv == 3) D += reduced_momentum<Spatial>(b, x, y.given);
    return b.parent < 0 || hand_on(k, M, D, a);
  }
  if (b.nv == 3) {
    for (int i = 0; i < 3; ++i)
      y.g[i] = o.C[3] * x.I(i, 0) + o.C[4] * x.I(i, 1) + o.C[5] * x.I(i, 2);
    for (int i = 0; i < 3; ++i) eliminate_slots(o.C[3 + i], y.g[i], own[i] - x.D.n[i]);
    for (int i = 0; i < 3; ++i)
      o.C[i] -= o.C[3] * x.H(i, 0) + o.C[4] * x.H(i, 1) + o.C[5] * x.H(i, 2);
    for (int i = 0; i < 3; ++i) o.C[3 + i] = y.g[i] * S(b.rotor);
    if constexpr (!Momentum) {
      for (int i = 0; i < 6; ++i) o.d += o.C[i] * y.given[i];
      D += reduced_momentum<Spatial>(b, x, y.given);
    }
    columns_inward(k, open, o);
    return b.parent < 0 || hand_on(k, M, D, a);
  }
  // Angular: I⁻¹ c_n; then A⁻¹ (c_f − H I⁻¹ c_n).
  Column left[3];
  for (int i = 0; i < 3; ++i) {
    y.g[3 + i] = o.C[3] * x.I(i, 0) + o.C[4] * x.I(i, 1) + o.C[5] * x.I(i, 2);
    left[i] = o.C[i] - (o.C[3] * x.H(i, 0) + o.C[4] * x.H(i, 1) + o.C[5] * x.H(i, 2));
  }
  for (int i = 0; i < 3; ++i) eliminate_slots(o.C[3 + i], y.g[3 + i], own[3 + i] - x.D.n[i]);
  for (int i = 0; i < 3; ++i)
    y.g[i] = left[0] * x.A(i, 0) + left[1] * x.A(i, 1) + left[2] * x.A(i, 2);
  for (int i = 0; i < 3; ++i) eliminate_slots(left[i], y.g[i], x.y[i]);
  for (int i = 0; i < 6; ++i) o.C[i] = {};
  return b.parent < 0 || hand_on(k, M, D, a);
}

/// C' by the whole way to the parent, of joints whose own is a rotation and a position.
template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::columns_inward(std::size_t k, SlotGroups open,
                                                                Blocks& o) const {
  const auto& b = body(k);
  Spatial::Pose<S> way;
  way.axes = identity3<S>();
  way = Spatial::pose_outward(b.edge, b.kind,
                              joints_[static_cast<std::size_t>(tree_->links[k].record)].edge, way);
  each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
    typename Column::Part C[6];
    each<6>([&](auto j) MOMENTA_INLINED { C[j] = o.C[j].v[i]; });
    columns_to_parent<Column>(way.axes, way.origin, C);
    each<6>([&](auto j) MOMENTA_INLINED { o.C[j].v[i] = C[j]; });
  });
}

/// (M', D') and the first moment of the subtree to the parent.
template <class S, int Rows, bool Momentum, class Tree>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::hand_on(std::size_t k,
                                                         const Spatial::ArticulatedInertia<S>& M,
                                                         const Force& D, Carried& a) const {
  const auto& b = body(k);
  const auto& x = joints_[static_cast<std::size_t>(tree_->links[k].record)];
  Vec3<S> G{};
  if constexpr (Momentum)
    G = Spatial::moment_to_parent(b.edge, b.kind, x.edge, x.moment, b.subtree_mass);
  set_articulated(a.articulated, Spatial::to_parent(b.edge, b.kind, x.edge, M),
                  Spatial::to_parent(b.edge, b.kind, x.edge, D), G);
  return true;
}

}  // namespace momenta
