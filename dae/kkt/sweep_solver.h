#pragma once
#include <momenta/dae/kkt/loop_solver.h>

namespace momenta {

/// Solves by the sweeps that carry loops. @pre mechanism.looped_sweeps() exists.
std::unique_ptr<LoopSolver> make_sweep_solver(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
