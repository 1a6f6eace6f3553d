#pragma once
// The instruction levels that this build and this machine both have, ascending.

#include <momenta/core/kernel/levels/level.h>

#include <vector>

namespace momenta::equations {

inline std::vector<int> levels() {
  std::vector<int> all;
  for (const int level : {1, 3, 4})
    if (level_at_most(level) == level) all.push_back(level);
  return all;
}

}  // namespace momenta::equations
