#pragma once
// The joint-space mass matrix M of (3) and (7) by composite inertias: M_KL = E_Lᵀ (𝒯ᶠ M^c_K E_K)
// for every ancestor L of K, M^c the rigid inertia of K's subtree. Only these entries are nonzero.
// Cost O(bodies × depth).

#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// Calls entry(row, column, value) with row ≤ column places in u; needs edges current. One call per
/// pair of dofs that lie on one path to the root, upper triangle only.
template <class Space, class S, class Entry>
void mass_matrix_inward(Workspace<Space, S>& w, Entry&& entry) {
  const auto& model = *w.model;
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    w.body[k].M = {};
    Space::add(w.body[k].M, w.inertia(k));
  }
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = model.bodies[k];
    const auto& s = w.body[k];
    for (int column = 0; column < b.nv; ++column) {
      S unit[6]{};
      unit[column] = S(1.0);
      typename Space::template Motion<S> motion{};
      Joint<Space>::add_motion(b, s.edge, unit, motion);
      auto force = Space::momentum(s.M, motion);
      S row[6];
      Joint<Space>::project(b, s.edge, force, row);
      for (int i = 0; i <= column; ++i) entry(b.u + i, b.u + column, row[i]);
      for (std::size_t at = k; model.bodies[at].parent >= 0;) {
        const auto& child = model.bodies[at];
        force = Space::to_parent(child.edge, child.kind, w.body[at].edge, force);
        at = static_cast<std::size_t>(child.parent);
        const auto& ancestor = model.bodies[at];
        if (ancestor.nv == 0) continue;
        Joint<Space>::project(ancestor, w.body[at].edge, force, row);
        for (int i = 0; i < ancestor.nv; ++i) entry(ancestor.u + i, b.u + column, row[i]);
      }
    }
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].M += Space::to_parent(b.edge, b.kind, s.edge, s.M);
  }
}

}  // namespace momenta
