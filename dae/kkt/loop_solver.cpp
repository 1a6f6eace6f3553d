#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>

namespace momenta {

std::unique_ptr<LoopSolver> make_loop_solver(const Mechanism& mechanism, Evaluation<double>& e) {
  return mechanism.solver().kkt() == KktChoice::sweeps ? make_sweep_solver(mechanism, e)
                                                       : make_assembled_solver(mechanism, e);
}

}  // namespace momenta
