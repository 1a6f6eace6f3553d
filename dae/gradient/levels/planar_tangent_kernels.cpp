#include <momenta/dae/gradient/levels/tangent_sweeps_at.h>

namespace momenta {
template std::unique_ptr<TangentSweeps> tangent_sweeps_at<MOMENTA_KERNEL_LEVEL>(
    const PlanarTree&, const SweptLoops<Planar>&, double, bool);
template std::unique_ptr<NumberSweep> number_sweep_at<MOMENTA_KERNEL_LEVEL>(
    const Model<Planar>&, const LoopModel<Planar>&, bool);
template std::unique_ptr<KineticSweep> kinetic_sweep_at<MOMENTA_KERNEL_LEVEL>(const Model<Planar>&);
}  // namespace momenta
