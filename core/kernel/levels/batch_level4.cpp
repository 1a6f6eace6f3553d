#include <momenta/core/kernel/levels/batch_sweeps_at.h>

namespace momenta {
template std::unique_ptr<BatchSweeps> batch_sweeps_at<4>(const LinkTree&);
template std::unique_ptr<BatchSweeps> batch_sweeps_at<4>(const PlanarTree&);
}  // namespace momenta
