#include <momenta/dae/kkt/sweeps/levels/loop_sweeps_at.h>

namespace momenta {
template std::unique_ptr<LoopedSweeps> looped_sweeps_at<MOMENTA_KERNEL_LEVEL>(
    const PlanarTree&, const SweptLoops<Planar>&, LoopedBranchGroups);
}  // namespace momenta
