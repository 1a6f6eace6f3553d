#pragma once
// The answer of a study in a few sentences, each borne out by the numbers of this very study.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// First what is not to be relied on, reservations(), where there is any. Then drift and its
/// growth, of `acceleration` against `momentum` with its gauge (same integrator) where both
/// finished, else of the best and the worst run. Then the best run by error against the reference,
/// or by drift and energy where there is none, and its time. Last, where runs failed: which, when,
/// why. Forms stand in backquotes, growth as t^1.98; plain text otherwise.
std::string conclusion(const StudyResult&);

/// Runs that are done with the balance of energy or the rates of loops off, which are not compared
/// with others, and a motion that is ambiguous; empty: neither.
std::string reservations(const StudyResult&);

/// All but the last sentence, what came out: empty when no run finished.
std::string answer(const StudyResult&);

/// Its last sentence: empty when every run finished.
std::string failures(const StudyResult&);

}  // namespace momenta
