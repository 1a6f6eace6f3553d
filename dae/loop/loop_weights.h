#pragma once
// What turns and slides in loops, weighed at the loops' points at the start: scales below which
// rows of points are dust, and masses too far apart for joints to be eliminated before the loops
// that hold them. A joint's inertia is weighed at the end of the way from it to the loop's point:
// so a uniform chain stays a chain of equals, whatever its length.

#include <momenta/dae/loop/loop_model.h>

#include <string>
#include <vector>

namespace momenta {

/// Heavier by this, a joint is not to be taken together with a lighter one of its loop: beside a
/// mobility so much larger the filter of the pivots takes what it has of a row.
inline constexpr double masses_far_apart = 1e6;

struct LoopWeights {
  /// Per loop: what unit forces on levers of 10⁻⁴ lengths of the scene move; zero for couplers.
  /// [1/kg]
  std::vector<double> least_scales;
  /// Of all loops: heaviest over lightest, at least 1.
  double spread = 1;
  /// Which joint is `masses_far_apart` from another of its loop, in words; empty: none.
  std::string light;
};

/// `inertia`: M_jj (nv) at the start; `length`: of the scene. O(length of all loops)
template <class Space>
LoopWeights weigh_loops(const LoopModel<Space>& loops, const Tree& tree,
                        const std::vector<double>& inertia, double length);

}  // namespace momenta
