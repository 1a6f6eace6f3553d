#pragma once
// Joints in loops, weighed at the loops' points at the start: scales below which rows of points are
// rounding, and how far masses are apart. A joint's inertia is weighed at the end of the way from
// it to the loop's point: so a uniform chain stays a chain of equals, whatever its length.

#include <momenta/dae/mechanism/loop/loop_model.h>

#include <string>
#include <vector>

namespace momenta {

/// Mass ratio beyond which the regularisation of KLU and of the DAE forms is weakened in
/// proportion.
inline constexpr double masses_far_apart = 1e6;

struct LoopWeights {
  /// Per loop: mobility under unit forces on levers of 10⁻⁴ lengths of the scene; zero for
  /// couplers. [1/kg]
  std::vector<double> least_scales;
  /// Heaviest over lightest joint of all loops, at least 1.
  double spread = 1;
  /// Heaviest over lightest joint of the loop where that is the most, at least 1.
  double apart = 1;
  /// Lightest and heaviest joint of that loop in words; empty where joints of loops do not weigh.
  std::string light;
};

/// `inertia`: M_jj (nv) at the start; `length`: of the scene. O(length of all loops)
template <class Space>
LoopWeights weigh_loops(const LoopModel<Space>& loops, const Tree& tree,
                        const std::vector<double>& inertia, double length);

}  // namespace momenta
