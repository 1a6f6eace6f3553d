#pragma once
// The penalty of the augmented Lagrangians: α of a row is `penalty` times the loop's effective mass
// 1/W at the start, W = Φ_q M⁻¹ Φ_qᵀ, one for all rows of a loop that share a unit.

#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/loop_units.h>

namespace momenta {

inline constexpr int penalty_iterations = 2;
inline constexpr double usual_penalty = 1e7;

/// α⁻¹ by row of Φ (m); `penalty` 0: the usual one.
inline std::vector<double> penalty_compliance(const Mechanism& mechanism, Evaluation<double>& e,
                                              double penalty, const Start& start) {
  e.place(start.t, start.q.data());
  std::vector<double> compliance = row_scales(mechanism, e);
  for (double& c : compliance) c /= penalty > 0 ? penalty : usual_penalty;
  return compliance;
}

/// Softens the solver by 1/α and returns the penalty in force, 0 without loops (no solver).
inline double soften(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver,
                     const FormOptions& options, const Start& start) {
  if (!solver) return 0;
  solver->soften(penalty_compliance(mechanism, e, options.penalty, start));
  return options.penalty > 0 ? options.penalty : usual_penalty;
}

}  // namespace momenta
