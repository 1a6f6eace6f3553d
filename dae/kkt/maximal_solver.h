#pragma once
#include <momenta/dae/kkt/loop_solver.h>

namespace momenta {

/// Solves by the sparse block matrix of all bodies' velocities and joints' multipliers
/// (maximal_tree.h), loops by the small matrix they leave. O(bodies) for a tree, O(bodies m² + m³)
/// with m loop equations. `e` as for make_loop_solver.
std::unique_ptr<LoopSolver> make_maximal_solver(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
