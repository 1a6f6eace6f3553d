#pragma once
// The answer of a study in a few sentences, each borne out by the numbers of this very study.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// Runs whose slopes of sub-ranges spread wider than this have not grown as a power of t.
inline constexpr double power_law_half_range = 0.3;

/// First sentence: drift and its growth, of `acceleration` against `momentum` with its gauge (same
/// integrator) where both finished, else of the best and the worst run. Second: the best run by
/// error against the reference, or by drift and energy where there is none, and its time. Third,
/// where runs failed: which, when, why. Forms stand in backquotes, growth as t^1.98; plain text
/// otherwise.
std::string conclusion(const StudyResult&);

/// Its first two sentences, what came out: empty when no run finished.
std::string answer(const StudyResult&);

/// Its last sentence: empty when every run finished.
std::string failures(const StudyResult&);

}  // namespace momenta
