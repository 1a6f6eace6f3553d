#include <momenta/dae/kkt/sweeps/levels/spatial_packs.h>

namespace momenta {
MOMENTA_SPATIAL_PACKS(, MOMENTA_KERNEL_LEVEL)
}  // namespace momenta
