#pragma once
// The recursion of the paper for trees of any joints: (q, p, t) → (q̇, ṗ) in two sweeps, eqs. (35),
// (37)-(48).
//
// Inward: M*, D, and the first moment of each subtree. Outward: W, u by (45), Ω, P* = M* Ω + D by
// (42), ṗ by (35). Weight needs no accumulated T*: the subtree's mass is a model constant and its
// first moment rides inward, so Eᵀ T* = Eᵀ (m g, m c × g) on the way out. Wrenches that depend on
// positions or velocities of several bodies (springs, dampers between points) are known only after
// the outward sweep: then, and only then, a third sweep gathers them.

#include <momenta/core/kernel/articulated.h>
#include <momenta/core/kernel/forces.h>

namespace momenta {

/// u (nv) and ṗ (nv) from (q, p, t). Returns false when a joint's articulated inertia is not
/// positive (w.singular).
template <class Space, class S>
bool momentum_recursion(Workspace<Space, S>& w, const S& t, const S* q, const S* p, S* u, S* pdot) {
  const auto& model = *w.model;
  const bool third_sweep = model.has_body_forces();
  poses_outward(w, t, q, third_sweep);

  articulated_masses_inward(w);
  if (w.singular >= 0) return false;
  for (auto& s : w.body) s.D = {};
  remainders_inward(w, p, [&](std::size_t k, auto& D) {
    const auto& s = w.body[k];
    if (model.bodies[k].drive >= 0)  // M' = M* for a driven joint, and h holds M* E
      for (int i = 0; i < Space::dimension; ++i) D[i] += s.h[i] * s.drive_rate;
  });
  const bool carry_weight = model.has_gravity && !third_sweep;
  if (carry_weight)
    for (std::size_t k = w.body.size(); k-- > 0;) {
      const auto& b = model.bodies[k];
      auto& s = w.body[k];
      const auto& own = w.inertia(k);
      for (int i = 0; i < static_cast<int>(std::size(s.mc.x)); ++i) s.mc[i] += own.mc[i];
      if (b.parent >= 0)
        w.body[static_cast<std::size_t>(b.parent)].mc +=
            Space::moment_to_parent(b.edge, b.kind, s.edge, s.mc, b.subtree_mass);
    }

  if (model.has_gravity) gravity_outward(w);
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const auto& b = model.bodies[k];
    auto& s = w.body[k];
    s.V = b.parent < 0 ? typename Space::template Motion<S>{}
                       : Space::to_child(b.edge, b.kind, s.edge,
                                         w.body[static_cast<std::size_t>(b.parent)].V);
    add_drive<Space, S>(b, s, s.V);
    solve_joint(w, k, s.V, u);
    s.P = Space::momentum(s.M, s.V);  // (42)
    s.P += s.D;
    if (third_sweep || b.nv == 0) continue;
    typename Space::template Force<S> net{};
    if (carry_weight) net = Space::weight(S(b.subtree_mass), s.mc, s.g);
    net -= Space::cross_force(s.V, s.P);
    Joint<Space>::project(b, s.edge, net, pdot + b.u);  // (35)
    if (b.nv == 1 && model.has_joint_forces) pdot[b.u] += joint_force(b, q[b.q], u[b.u]);
  }
  if (carry_weight)
    for (auto& s : w.body) s.mc = {};
  if (third_sweep) {
    apply_forces(w, true);
    momentum_rates_inward(w, q, u, pdot);
  }
  return true;
}

/// p = M u + the prescribed part, eq. (34), from (q, u, t). Leaves body[k].P = P*_K.
template <class Space, class S>
void momenta_from_rates(Workspace<Space, S>& w, const S& t, const S* q, const S* u, S* p) {
  poses_outward(w, t, q, false);
  velocities_outward(w, u);
  body_momenta(w);
  momenta_inward(w, p);
}

/// x ← M⁻¹ x at the configuration of the last articulated_masses_inward, prescribed motion left
/// out. O(bodies).
template <class Space, class S>
void inverse_mass_times(Workspace<Space, S>& w, const S* x, S* result) {
  for (auto& s : w.body) s.D = {};
  remainders_inward(w, x, [](std::size_t, auto&) {});
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const auto& b = w.model->bodies[k];
    auto& s = w.body[k];
    s.A = b.parent < 0 ? typename Space::template Motion<S>{}
                       : Space::to_child(b.edge, b.kind, s.edge,
                                         w.body[static_cast<std::size_t>(b.parent)].A);
    solve_joint(w, k, s.A, result);
  }
}

}  // namespace momenta
