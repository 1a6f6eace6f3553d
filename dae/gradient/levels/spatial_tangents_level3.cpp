#include <momenta/dae/gradient/levels/tangent_sweeps_at.h>

namespace momenta {
template std::unique_ptr<TangentSweeps> tangent_sweeps_at<3>(const LinkTree&,
                                                             const SweptLoops<Spatial>&, double,
                                                             bool);
template std::unique_ptr<NumberSweep> number_sweep_at<3>(const Model<Spatial>&,
                                                         const LoopModel<Spatial>&, bool);
template std::unique_ptr<KineticSweep> kinetic_sweep_at<3>(const Model<Spatial>&);
}  // namespace momenta
