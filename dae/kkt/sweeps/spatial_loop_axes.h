#pragma once
// Joints on one axis beside revolute ones, with loops: prismatic joints, screws, driven and
// welded ones. The steps of core/kernel/axis_joint.h, and of the open loops, with E = (e_f ẑ; e_n
// ẑ),
//
//   c = EᵀC, W' = W + c c ᵀ M_j⁻¹, d' = d + c e M_j⁻¹, C' = C − h cᵀ. Part of
//   spatial_loop_sweeps.h.

#include <momenta/core/kernel/axis_joint.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::axis_inward(std::size_t k, const In& r,
                                                             const RightSide<S>& right,
                                                             Carried& a) {
  const auto& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  auto& y = any_[static_cast<std::size_t>(l.record)];
  Articulated<S>& m = a.articulated;
  Blocks& o = a.blocks;
  const SlotGroups open = open_slots_.fronts[k].open;
  o.begin(false, ~open);
  if constexpr (Momentum) {
    if (b.nv > 0) {
      x.M = blocks(m.M);
      x.D = remainder_of(m);
      x.moment = {{m.Gx, m.Gy, m.Gz}};
      if (open)
        for (const int i : {0, 1, 3, 4}) y.C[i] = o.C[i];  // the rows of P* that ṗ asks for
    }
  }
  const bool slides = b.kind == JointKind::prismatic, only_turns = b.kind == JointKind::revolute;
  if (b.nv > 0) {
    S own = r[l.u];
    if (right.centre)
      each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int) {
        own = own - j.ratio * right.centre[loops_->loops[loop].row];
      });
    if (!eliminate_axis(b, own, m, x)) return false;
  }
  if (b.nv > 0 && open) {
    Column c = slides ? o.C[2] : o.C[5];
    if (!slides && !only_turns) c += o.C[2] * S(b.pitch);
    each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int slot) {
      c.add(slot, S(j.ratio));
      if (j.first) o.d.add(slot, coupled_[loop]);
    });
    o.eliminate(c, x.pivot, x.pivot * x.e, open, 0, y.g[0]);
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
      o.scale.v[i] = o.scale.v[i] + c.v[i] * y.g[0].v[i];
      each<6>([&](auto j)
                  MOMENTA_INLINED { o.C[j].v[i] = o.C[j].v[i] - c.v[i] * Column::all(x.h[j]); });
    });
  }
  if constexpr (!Momentum)
    if (l.parent < 0) {
      const auto& g = tree_->model->gravity;
      y.given.v -=
          Spatial::direction_to_child(b.edge, b.kind, x.edge, Vec3<S>{{S(g[0]), S(g[1]), S(g[2])}});
    }
  if (!Momentum || b.nv == 0) {  // D' += M'c, d' += C'ᵀ c of a given motion
    const Force P = Spatial::momentum(blocks(m.M), y.given);
    add_remainder(m, P);
    if (open)
      for (int i = 0; i < 6; ++i) o.d += o.C[i] * y.given[i];
  }
  if (l.parent < 0) return true;
  carry_axis<Momentum>(l, b.edge, x.edge, b.subtree_mass, m);
  if (!open) return true;
  each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
    typename Column::Part C[6];
    each<6>([&](auto j) MOMENTA_INLINED { C[j] = o.C[j].v[i]; });
    screw_columns<2>(C, Column::all(x.edge.cos_theta), Column::all(x.edge.sin_theta),
                     Column::all(x.edge.d));
    columns_to_parent(b.edge, C);
    each<6>([&](auto j) MOMENTA_INLINED { o.C[j].v[i] = C[j]; });
  });
  return true;
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In, class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::axis_outward(std::size_t k, const In& q,
                                                              bool rates, Moving& moving, Out u,
                                                              Out rate) {
  const auto& l = tree_->links[k];
  const auto& b = body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  const auto& y = any_[static_cast<std::size_t>(l.record)];
  const auto along = [&](const Column& c)
                         MOMENTA_INLINED { return along_sigma(k, c, moving.sigma); };
  Vec3<S>&v = moving.V.v, &o = moving.V.w, &g = moving.g;
  OutwardMotion<S> w{v[0], v[1], v[2], o[0], o[1], o[2], g[0], g[1], g[2]};
  constants_and_screw_outward<Momentum>(l, b.edge, x.edge, w);
  if (!Momentum || b.nv == 0) add_motion(w, y.given);
  if (b.nv > 0) {
    const S own = axis_rate(x, w) - along(y.g[0]);
    add_axis_motion(b, own, w);
    u[l.u] = own;
    if constexpr (Momentum)
      if (rates) {
        for (const int i : {0, 1, 3, 4}) x.D[i] += along(y.C[i]);
        S pdot = axis_momentum_rate<true>(b, x, w);
        if (l.has_force) pdot = pdot + joint_force(b, S(q[l.q]), own);
        rate[l.u] = pdot;
      }
  }
  v = {{w.vx, w.vy, w.vz}};
  o = {{w.ox, w.oy, w.oz}};
  if constexpr (Momentum) g = {{w.gx, w.gy, w.gz}};
}

}  // namespace momenta
