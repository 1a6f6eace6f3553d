#pragma once
// A mechanism as pages show it: in words, standing at its start, and as its runs moved it.

#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// What there is to see, in a sentence or two.
std::string still_words(const Mechanism& mechanism, const Assembly& assembly);

/// @throws std::invalid_argument for a mechanism too large to be drawn
void expect_drawable(const Mechanism& mechanism);

/// The mechanism's picture and the motions of the runs that were filmed, else its start. Nothing of
/// a mechanism too large to be drawn.
void show(StudyResult& study, const Mechanism& mechanism, const Assembly& assembly);

}  // namespace momenta
