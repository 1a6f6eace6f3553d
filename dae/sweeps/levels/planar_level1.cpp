#include <momenta/dae/sweeps/levels/loop_sweeps_at.h>

namespace momenta {
template std::unique_ptr<LoopedSweeps> looped_sweeps_at<1>(const PlanarTree&,
                                                           const SweptLoops<Planar>&,
                                                           LoopedBranchGroups);
}  // namespace momenta
