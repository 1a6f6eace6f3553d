#pragma once
#include <momenta/dae/kkt/loop_solver.h>

namespace momenta {

/// Solves with the mechanism's assembled matrix, dense or sparse.
std::unique_ptr<LoopSolver> make_assembled_solver(const Mechanism& mechanism,
                                                  Evaluation<double>& e);

}  // namespace momenta
