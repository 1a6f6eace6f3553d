#pragma once
// Both recursions on a workspace alone, for one evaluation: links and sweeps are made for it.

#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/momentum_recursion.h>

namespace momenta::equations {

template <class Space, class S>
bool momentum_recursion(Workspace<Space, S>& w, const S& t, const S* q, const S* p, S* u, S* pdot) {
  const auto links = build_links(*w.model);
  MomentumSweeps<Space, S> sweeps(links);
  return momenta::momentum_recursion(sweeps, w, t, q, p, u, pdot);
}

template <class Space, class S>
bool acceleration_recursion(Workspace<Space, S>& w, const S& t, const S* q, const S* u, S* udot) {
  const auto links = build_links(*w.model);
  AccelerationSweeps<Space, S> sweeps(links);
  const bool ok = momenta::acceleration_recursion(sweeps, w, t, q, u, udot);
  if (ok) {  // what Newton-Euler takes from here
    poses_outward(w, t, q, true);
    velocities_outward(w, u);
    gravity_outward(w);
  }
  return ok;
}

}  // namespace momenta::equations
