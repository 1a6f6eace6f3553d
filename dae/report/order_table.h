#pragma once
// Observed orders of the ladders of a work study, as a table on the terminal.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// One row a ladder (form, integrator, gauge) with the observed orders (measure/observed_order.h)
/// of the errors of coordinates, of rates, of λ from (3) and of the form's own λ against the
/// reference, and of σ; each with its half range. No reference has σ: changes of |σ|₂ at the output
/// times from rung to rung give its order, "-" where the gauge resets or flips σ. "-" also for
/// fewer than three rungs. A note below explains the head.
std::string order_table(const StudyResult&);

}  // namespace momenta
