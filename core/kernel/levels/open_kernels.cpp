#include <momenta/core/kernel/levels/open_sweeps_at.h>

namespace momenta {
template std::unique_ptr<OpenSweeps> sweeps_at<MOMENTA_KERNEL_LEVEL>(const LinkTree&,
                                                                     const Branches*);
template std::unique_ptr<OpenSweeps> sweeps_at<MOMENTA_KERNEL_LEVEL>(const PlanarTree&);
}  // namespace momenta
