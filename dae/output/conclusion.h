#pragma once
// The answer of a study in a few sentences, based on its own numbers.

#include <momenta/dae/run/run_result.h>

#include <string>

namespace momenta {

/// First reservations(), if any. Then drift and its growth, of `acceleration` against `momentum`
/// with its gauge (same integrator) where both finished, else of the best and the worst run. Then
/// the best run by error against the reference, or without one by drift and energy, and its time.
/// Last, failed runs: which, when, why. Forms in backquotes, growth as t^1.98; plain text
/// otherwise.
std::string conclusion(const StudyResult&);

/// Runs not compared, as the balance of energy or the rates of loops are off, and an ambiguous
/// motion; empty: neither.
std::string reservations(const StudyResult&);

/// All but the last sentence; empty when no run finished.
std::string answer(const StudyResult&);

/// The last sentence; empty when every run finished.
std::string failures(const StudyResult&);

}  // namespace momenta
