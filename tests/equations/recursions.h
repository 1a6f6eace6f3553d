#pragma once
// Both recursions on a workspace alone, for one evaluation: links and sweeps are made for it. On
// numbers that several tests use they are compiled once, in recursions.cpp.

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

extern template bool momentum_recursion(Workspace<Spatial, double>&, const double&, const double*,
                                        const double*, double*, double*);
extern template bool momentum_recursion(Workspace<Planar, double>&, const double&, const double*,
                                        const double*, double*, double*);
extern template bool momentum_recursion(Workspace<Spatial, Dual8>&, const Dual8&, const Dual8*,
                                        const Dual8*, Dual8*, Dual8*);
extern template bool acceleration_recursion(Workspace<Spatial, double>&, const double&,
                                            const double*, const double*, double*);
extern template bool momentum_recursion(Workspace<Planar, Dual8>&, const Dual8&, const Dual8*,
                                        const Dual8*, Dual8*, Dual8*);
extern template bool acceleration_recursion(Workspace<Planar, double>&, const double&,
                                            const double*, const double*, double*);

}  // namespace momenta::equations
