#pragma once
// The state at the end of a run, made consistent.

#include <momenta/dae/run/run_form.h>

namespace momenta {

/// Start at t, q, u of the run's last row, with the loops closed. @throws SceneError where the run
/// does not get there (why), or no pose closes the loops
Start state_after(const Mechanism& mechanism, const Start& start, const RunSettings& settings,
                  double max_cpu_seconds);

}  // namespace momenta
