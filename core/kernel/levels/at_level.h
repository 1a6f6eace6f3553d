#pragma once
// A level known at run time as a compile-time constant.

#include <momenta/core/kernel/levels/level.h>

#include <stdexcept>

namespace momenta {

/// act.operator()<Level>()
template <class Act>
auto at_level([[maybe_unused]] int level, Act&& act) {
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
