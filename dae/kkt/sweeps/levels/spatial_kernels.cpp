#include <momenta/dae/kkt/sweeps/levels/loop_sweeps_at.h>
#include <momenta/dae/kkt/sweeps/levels/spatial_packs.h>

namespace momenta {
MOMENTA_SPATIAL_PACKS(extern, MOMENTA_KERNEL_LEVEL)
template std::unique_ptr<LoopedSweeps> looped_sweeps_at<MOMENTA_KERNEL_LEVEL>(
    const LinkTree&, const SweptLoops<Spatial>&, LoopedBranchGroups);
}  // namespace momenta
