#pragma once
// What a run says of stiffness: since when stability held the steps of an explicit method, and what
// went on in its place or is to be chosen.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// One sentence; empty where no stiffness was found.
std::string stiffness_in_words(const RunResult& run);

}  // namespace momenta
