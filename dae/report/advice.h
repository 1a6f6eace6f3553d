#pragma once
// The result of a work study in words.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// "For an error of 1e-6 take …": for each decade the cheapest run that reaches it, and how many
/// times longer the best of other forms takes. One line each, names in backquotes; also decades
/// that no run reaches. Without a reference the largest drift stands for the error.
std::string advice(const StudyResult& study);

}  // namespace momenta
