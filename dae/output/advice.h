#pragma once
// Stiffness of a run: since when stability held the steps of an explicit method, and the method
// that took over or is to be chosen.

#include <momenta/dae/run/run_result.h>

#include <string>

namespace momenta {

/// One sentence; empty without stiffness.
std::string stiffness_in_words(const RunResult& run);

// The result of a work study in words.

/// "For an error of 1e-6 take …": for each decade the cheapest run that reaches it, and how many
/// times longer the best of other forms takes. One line each, names in backquotes; also decades
/// that no run reaches. Without a reference the largest drift stands for the error.
std::string advice(const StudyResult& study);

}  // namespace momenta
