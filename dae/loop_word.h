#pragma once
#include <momenta/dae/mechanism.h>

namespace momenta {

/// What messages call that which a row of Φ belongs to.
inline const char* loop_word(const Mechanism& mechanism) {
  return mechanism.scene().lagrangian ? "constraint" : "loop";
}

}  // namespace momenta
