#include <momenta/dae/gradient/levels/direction_sweeps_at.h>
#include <momenta/dae/gradient/levels/number_rows_at.h>

namespace momenta {
template std::unique_ptr<DirectionSweeps> direction_sweeps_at<MOMENTA_KERNEL_LEVEL>(
    const LinkTree&, const SweptLoops<Spatial>&, double, bool);
template std::unique_ptr<NumberRows> number_rows_at<MOMENTA_KERNEL_LEVEL>(
    const Model<Spatial>&, std::size_t, const LoopModel<Spatial>*);
}  // namespace momenta
