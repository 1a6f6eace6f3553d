#include <momenta/dae/gradient/levels/mixed_sweep_at.h>

namespace momenta {
template std::unique_ptr<MixedSweep> mixed_sweep_at<MOMENTA_KERNEL_LEVEL>(const Model<Planar>&,
                                                                          const LoopModel<Planar>&,
                                                                          bool);
template std::unique_ptr<MixedSweep> mixed_sweep_at<MOMENTA_KERNEL_LEVEL>(const Model<Spatial>&,
                                                                          const LoopModel<Spatial>&,
                                                                          bool);
}  // namespace momenta
