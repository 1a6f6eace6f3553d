#pragma once
// The terminal's table of a study.

#include <momenta/dae/run/run_result.h>

#include <string>

namespace momenta {

/// One row a run, columns padded; "-" for missing measurements. Below, one line for each run that
/// did not finish: where it stopped and why.
std::string drift_table(const StudyResult&);

// Observed orders of the ladders of a work study, as a table on the terminal.

/// One row a ladder (form, integrator, gauge) with the observed orders (measure/growth.h)
/// of the errors of coordinates, of rates, of λ from (3) and of the form's own λ against the
/// reference, and of σ; each with its half range. No reference has σ: changes of |σ|₂ at the output
/// times from rung to rung give its order, "-" where the gauge resets or flips σ. "-" also for
/// fewer than three rungs. A note below explains the head.
std::string order_table(const StudyResult&);

}  // namespace momenta
