#pragma once
// The table that a study prints on the terminal.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// One row per run, columns padded to their widest cell; "-" where nothing was measured. Below it,
/// one line for each run that did not finish: where it stopped and why.
std::string drift_table(const StudyResult&);

}  // namespace momenta
