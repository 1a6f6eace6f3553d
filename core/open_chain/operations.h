#pragma once
// Number of operations of one evaluation of an open chain, counted by running the kernels on
// counting numbers.

#include <momenta/core/kernel/plan.h>
#include <momenta/core/scalar/counted.h>

namespace momenta {

/// The two recursions.
enum class Recursion {
  momentum,     ///< (q, p, t) → (u, ṗ)
  acceleration  ///< (q, u, t) → u̇
};

/// Counts one evaluation, without forces between points of bodies. Cost O(bodies). @pre the tree
/// and plan of the scene.
OperationCount count_operations(const Tree& tree, const Scene& scene, const Plan& plan,
                                Recursion recursion);

}  // namespace momenta
