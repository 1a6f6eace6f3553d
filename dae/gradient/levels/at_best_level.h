#pragma once
// The choice of a level for what is compiled for several.

#include <momenta/core/kernel/levels/level.h>

#include <stdexcept>

namespace momenta {

/// act of the best level, as a constant.
template <class Act>
auto at_best_level(Act&& act) {
  [[maybe_unused]] const int level = best_level();
#ifdef MOMENTA_LEVEL4
  if (level >= 4) return act.template operator()<4>();
#endif
#ifdef MOMENTA_LEVEL3
  if (level >= 3) return act.template operator()<3>();
#endif
#ifdef MOMENTA_LEVEL1
  if (level >= 1) return act.template operator()<1>();
#endif
  throw std::logic_error("no kernels of this level");
}

}  // namespace momenta
