#pragma once
// The recursion of the paper for the rest of the toolkit: (q, p, t) → (u, ṗ), u → p, and M⁻¹. The
// two sweeps are in momentum_sweeps.h and planar_momentum_sweeps.h; wrenches between points of
// bodies need poses and velocities known only after them: a third sweep adds their Eᵀ T* to ṗ.

#include <momenta/core/kernel/body_forces.h>
#include <momenta/core/kernel/inverse_mass.h>

namespace momenta {

/// u (nv) and ṗ (nv) from (q, p, t), eqs. (35), (37)-(48). False at a singular joint
/// (sweeps.singular_joint()). `w` serves the third sweep alone. O(bodies).
template <class Space, class S>
bool momentum_recursion(MomentumSweeps<Space, S>& sweeps, Workspace<Space, S>& w, const S& t,
                        const S* q, const S* p, S* u, S* pdot) {
  if (!sweeps(t, q, p, u, pdot)) return false;
  if (w.model->has_body_forces()) {
    body_force_rates(w, t, q, u);
    for (int i = 0; i < w.model->nv; ++i) pdot[i] += w.generalised[static_cast<std::size_t>(i)];
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

}  // namespace momenta
