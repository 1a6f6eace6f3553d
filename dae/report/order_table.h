#pragma once
// The observed orders of the ladders of a work study, as a table on the terminal.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// One row per ladder (form, integrator, gauge) with the observed orders (measure/observed_order.h)
/// of the errors of coordinates, of rates, of λ from (3) and of the form's own λ against the
/// reference, and of σ; each with its half range. Of σ, which no reference has, by what |σ|₂ at the
/// output times changes from rung to rung; where the gauge resets or flips σ it is "-", as is all
/// that fewer than three rungs show. A note on the signs of the head stands below.
std::string order_table(const StudyResult&);

}  // namespace momenta
