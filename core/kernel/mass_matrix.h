#pragma once
// The joint-space mass matrix M of (3) and (7) by composite inertias: M_KL = E_Lᵀ (𝒯ᶠ M^c_K E_K)
// for every ancestor L of K, M^c the rigid inertia of K's subtree. Other entries are zero. O(bodies
// × depth).

#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// Rigid inertias of all subtrees into body[k].M; `visit(k)` follows each once complete.
template <class Space, class S, class Visit>
void composite_inertias_inward(Workspace<Space, S>& w, Visit&& visit) {
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    w.body[k].M = {};
    Space::add(w.body[k].M, w.inertia(k));
  }
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = w.model->bodies[k];
    visit(k);
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].M +=
          Space::to_parent(b.edge, b.kind, w.body[k].edge, w.body[k].M);
  }
}

/// M^c E of one column of joint k's E, and the row of its own block: Eᵀ M^c E.
template <class Space, class S>
typename Space::template Force<S> composite_column(const Workspace<Space, S>& w, std::size_t k,
                                                   int column, S* row) {
  const auto& b = w.model->bodies[k];
  S unit[6]{};
  unit[column] = S(1.0);
  typename Space::template Motion<S> motion{};
  Joint<Space>::add_motion(b, w.body[k].edge, unit, motion);
  const auto force = Space::momentum(w.body[k].M, motion);
  Joint<Space>::project(b, w.body[k].edge, force, row);
  if (b.has_rotor()) row[column] += b.rotor;
  return force;
}

/// The diagonal of M (nv). Needs edges. O(bodies).
template <class Space, class S>
void mass_diagonal_inward(Workspace<Space, S>& w, S* diagonal) {
  composite_inertias_inward(w, [&](std::size_t k) {
    const auto& b = w.model->bodies[k];
    S row[6];
    for (int i = 0; i < b.nv; ++i) {
      composite_column(w, k, i, row);
      diagonal[b.u + i] = row[i];
    }
  });
}

/// Calls entry(row, column, value), row ≤ column places in u, for each pair of dofs on one path to
/// the root. Needs edges.
template <class Space, class S, class Entry>
void mass_matrix_inward(Workspace<Space, S>& w, Entry&& entry) {
  const auto& model = *w.model;
  composite_inertias_inward(w, [&](std::size_t k) {
    const auto& b = model.bodies[k];
    for (int column = 0; column < b.nv; ++column) {
      S row[6];
      auto force = composite_column(w, k, column, row);
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
  });
}

}  // namespace momenta
