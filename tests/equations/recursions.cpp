#include "equations/recursions.h"

namespace momenta::equations {

template bool momentum_recursion(Workspace<Spatial, double>&, const double&, const double*,
                                 const double*, double*, double*);
template bool momentum_recursion(Workspace<Planar, double>&, const double&, const double*,
                                 const double*, double*, double*);
template bool momentum_recursion(Workspace<Spatial, Dual8>&, const Dual8&, const Dual8*,
                                 const Dual8*, Dual8*, Dual8*);
template bool acceleration_recursion(Workspace<Spatial, double>&, const double&, const double*,
                                     const double*, double*);
template bool momentum_recursion(Workspace<Planar, Dual8>&, const Dual8&, const Dual8*,
                                 const Dual8*, Dual8*, Dual8*);
template bool acceleration_recursion(Workspace<Planar, double>&, const double&, const double*,
                                     const double*, double*);

}  // namespace momenta::equations
