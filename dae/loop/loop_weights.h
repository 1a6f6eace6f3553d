#pragma once
// What turns and slides in loops, weighed at the loops' points at the start: scales below which
// rows of points are dust, and how far masses are apart. A joint's inertia is weighed at the end of
// the way from it to the loop's point: so a uniform chain stays a chain of equals, whatever its
// length.

#include <momenta/dae/loop/loop_model.h>

#include <string>
#include <vector>

namespace momenta {

/// Of masses further apart what keeps the matrices of KLU and of the DAE forms regular is less by
/// as much.
inline constexpr double masses_far_apart = 1e6;

struct LoopWeights {
  /// Per loop: what unit forces on levers of 10⁻⁴ lengths of the scene move; zero for couplers.
  /// [1/kg]
  std::vector<double> least_scales;
  /// Of all loops: heaviest over lightest, at least 1.
  double spread = 1;
  /// Of the loop where that is the most: heaviest over lightest, at least 1.
  double apart = 1;
  /// Its lightest and its heaviest joint in words; empty where no loop has joints that weigh.
  std::string light;
};

/// `inertia`: M_jj (nv) at the start; `length`: of the scene. O(length of all loops)
template <class Space>
LoopWeights weigh_loops(const LoopModel<Space>& loops, const Tree& tree,
                        const std::vector<double>& inertia, double length);

}  // namespace momenta
