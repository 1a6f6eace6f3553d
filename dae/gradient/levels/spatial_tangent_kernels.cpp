#include <momenta/dae/gradient/levels/tangent_sweeps_at.h>

namespace momenta {
template std::unique_ptr<TangentSweeps> tangent_sweeps_at<MOMENTA_KERNEL_LEVEL>(
    const LinkTree&, const SweptLoops<Spatial>&, double, bool);
template std::unique_ptr<NumberSweep> number_sweep_at<MOMENTA_KERNEL_LEVEL>(
    const Model<Spatial>&, const LoopModel<Spatial>&, bool);
template std::unique_ptr<KineticSweep> kinetic_sweep_at<MOMENTA_KERNEL_LEVEL>(
    const Model<Spatial>&);
}  // namespace momenta
