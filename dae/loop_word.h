#pragma once
#include <momenta/dae/mechanism.h>

namespace momenta {

/// Word of messages for a constraint.
inline const char* loop_word(const Mechanism& mechanism) {
  return mechanism.scene().lagrangian ? "constraint" : "loop";
}

}  // namespace momenta
