#pragma once
// What a work study comes to, in words.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// "For an error of 1e-6 take …": for each decade wanted the cheapest run that reaches it, and how
/// many times longer the best of other forms takes. One line each, names in backquotes; what
/// no run reaches is said too. Without a reference the largest drift stands for the error.
std::string advice(const StudyResult& study);

}  // namespace momenta
