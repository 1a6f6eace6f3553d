#pragma once

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/start.h>

#include <string>

namespace momenta {

/// One sentence on rates of the scene that its loops do not allow, "start rates replaced by the
/// nearest that the loops allow: P.u0 from 0.3 to 0.0052 m/s"; empty where all are kept to a
/// thousandth of the largest. Rates of zero do not count as given.
std::string replaced_rates_in_words(const Mechanism& mechanism, const Start& start);

// Accelerations u̇ and multipliers λ of a start from its positions and rates, by the equations of
// motion with Φ̈ = 0, friction in bearings counted.

/// Fills udot (nv) and lambda (m) of a start whose t, q and u are consistent. Of a mechanism
/// without rates both are zero.
/// @throws SceneError naming a joint without inertia, a formula without value, a force in a bearing
/// that is not unique, or a loop without value
void start_accelerations(const Mechanism& mechanism, Evaluation<double>& e, Start& s);

/// @throws SceneError where a loop has no value at the pose that was evaluated last
void expect_no_lost_loop(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
