#include <momenta/dae/sweeps/levels/spatial_packs.h>

namespace momenta {
MOMENTA_SPATIAL_PACKS(, 4)
}  // namespace momenta
