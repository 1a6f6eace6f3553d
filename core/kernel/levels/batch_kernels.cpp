#include <momenta/core/kernel/levels/batch_sweeps_at.h>

namespace momenta {
template std::unique_ptr<BatchSweeps> batch_sweeps_at<MOMENTA_KERNEL_LEVEL>(const LinkTree&);
template std::unique_ptr<BatchSweeps> batch_sweeps_at<MOMENTA_KERNEL_LEVEL>(const PlanarTree&);
}  // namespace momenta
