#include <momenta/dae/gradient/levels/tangent_sweeps_at.h>

namespace momenta {
template std::unique_ptr<TangentSweeps> tangent_sweeps_at<3>(const PlanarTree&,
                                                             const SweptLoops<Planar>&, double,
                                                             bool);
template std::unique_ptr<NumberSweep> number_sweep_at<3>(const Model<Planar>&,
                                                         const LoopModel<Planar>&, bool);
template std::unique_ptr<KineticSweep> kinetic_sweep_at<3>(const Model<Planar>&);
}  // namespace momenta
