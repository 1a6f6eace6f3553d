#include <momenta/dae/sweeps/levels/spatial_packs.h>

namespace momenta {
MOMENTA_SPATIAL_PACKS(, 3)
}  // namespace momenta
