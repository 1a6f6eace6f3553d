#pragma once
// The number of operations of one evaluation of an open chain, counted by running the kernels
// themselves on counting numbers.

#include <momenta/core/plan.h>
#include <momenta/core/scalar/counted.h>

namespace momenta {

/// The two recursions.
enum class Recursion {
  momentum,     ///< (q, p, t) → (u, ṗ)
  acceleration  ///< (q, u, t) → u̇
};

/// Counts the operations of one evaluation. Forces between points of bodies are left out. Cost
/// O(bodies). @pre the tree and plan of the scene.
OperationCount count_operations(const Tree& tree, const Scene& scene, const Plan& plan,
                                Recursion recursion);

}  // namespace momenta
