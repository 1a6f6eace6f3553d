#include <momenta/core/kernel/levels/open_sweeps_at.h>

namespace momenta {
template std::unique_ptr<OpenSweeps> sweeps_at<3>(const LinkTree&, const Branches*);
template std::unique_ptr<OpenSweeps> sweeps_at<3>(const PlanarTree&);
}  // namespace momenta
