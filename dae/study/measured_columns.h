#pragma once
// Columns that a reference may have: the trajectory's with reactions, and behind them
//
//   JOINT.p     M u [N m s, N s], the momentum without Φ_qᵀσ: that part is the gauge's
//   LOOP.impulse1, …  ∫λ dt from the start, by row of Φ [N s, N m s]: of momentum forms
//                     Δσ + ∫κσ dt, whatever the gauge
//   work        of drives and of what has no potential, from the start [J]

#include <momenta/dae/mechanism.h>

#include <string>
#include <vector>

namespace momenta {

/// Names and units of M u (nv), in the order of u: "O.p [N m s]".
std::vector<Column> momentum_columns(const Mechanism& mechanism);
/// Names and units of ∫λ dt (m), by row of Φ: "B.impulse1 [N s]".
std::vector<Column> impulse_columns(const Mechanism& mechanism);

/// trajectory_columns() with reactions, M u, ∫λ dt and work, in this order.
std::vector<std::string> measured_columns(const Mechanism& mechanism);

}  // namespace momenta
