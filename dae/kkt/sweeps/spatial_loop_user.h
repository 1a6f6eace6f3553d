#pragma once
// User joints, with loops. Their E has up to six columns, eliminated one after the other as
// core/kernel/user_elimination.h does; the open loops take the same steps,
//
//   c_j = E_jᵀ Cʲ,  g_j = c_j / d_j,  W += c_j g_jᵀ,  d += g_j e_j,  Cʲ⁺¹ = Cʲ − h_j c_jᵀ
//
// and outward, from the last column to the first, with Ω = 𝒯ⱽΩ_L + Ω_t to begin with,
//
//   u_j = e_j / d_j − h_jᵀ Ω − g_jᵀ σ,  then Ω += E_j u_j.
//
// The given motion c (Ω_t; in acceleration form velocity products, Ė u and dΩ_t/dt),
// adds M' c to D' and C'ᵀ c to d. Ė of (35) acts on P* with the impulses of the loops below. Part
// of spatial_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::user_inward(std::size_t k, const In& r,
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
  D += reduced_momentum<Spatial>(b, x, y.given);
  if (open) {
    const UserRecord<S>& e = *x.user;
    for (int j = 0; j < b.nv; ++j) {
      const Motion& E = e.motion.E[j];
      Column c = o.C[0] * E[0];
      for (int i = 1; i < 6; ++i) c += o.C[i] * E[i];
      o.eliminate(c, e.inverse[j], e.inverse[j] * e.e[j], open, 0, y.g[j]);
      o.scale += c * y.g[j];
      for (int i = 0; i < 6; ++i) o.C[i] -= c * e.h[j][i];
    }
    if (b.nv == 6)  // nothing is left
      for (int i = 0; i < 6; ++i) o.C[i] = {};
    for (int i = 0; i < 6; ++i) o.d += o.C[i] * y.given[i];
    columns_inward(k, open, o);
  }
  return b.parent < 0 || hand_on(k, M, D, a);
}

template <class S, int Rows, bool Momentum, class Tree>
template <class Out>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::user_outward(std::size_t k, bool rates, Moving& m,
                                                              Out u, Out rate) {
  const auto& b = body(k);
  const auto record = static_cast<std::size_t>(tree_->links[k].record);
  const auto& x = joints_[record];
  const auto& y = any_[record];
  const UserRecord<S>& e = *x.user;
  if (b.parent >= 0) m.V = Spatial::to_child(b.edge, b.kind, x.edge, m.V);
  m.g = Spatial::direction_to_child(b.edge, b.kind, x.edge, m.g);
  m.V += y.given;
  S own[6];
  for (int j = b.nv; j-- > 0;) {
    own[j] = e.inverse[j] * e.e[j] - Spatial::power(e.h[j], m.V) - along_sigma(k, y.g[j], m.sigma);
    for (int i = 0; i < 6; ++i) m.V[i] += e.motion.E[j][i] * own[j];
    u[b.u + j] = own[j];
  }
  if (!rates) return;
  Force P;
  const Force net = net_wrench(k, m, P);
  S along[6];
  Joint<Spatial>::project(b, x.edge, net, along);
  Joint<Spatial>::move(b, x.edge, static_cast<const S*>(own));
  Joint<Spatial>::add_axis_rate(b, x.edge, P, along);
  for (int j = 0; j < b.nv; ++j) rate[b.u + j] = along[j];
}

}  // namespace momenta
