#pragma once
// Stiffness of a run: since when stability held the steps of an explicit method, and the method
// that took over or is to be chosen.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// One sentence; empty without stiffness.
std::string stiffness_in_words(const RunResult& run);

}  // namespace momenta
