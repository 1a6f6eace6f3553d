#pragma once
// The terminal's table of a study.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// One row a run, columns padded; "-" for missing measurements. Below, one line for each run that
/// did not finish: where it stopped and why.
std::string drift_table(const StudyResult&);

}  // namespace momenta
