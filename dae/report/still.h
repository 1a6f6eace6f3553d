#pragma once
// A mechanism as pages show it: in words, standing at its start, and as its runs moved it.

#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/report/meshes.h>
#include <momenta/dae/study/run_result.h>

#include <string>
#include <vector>

namespace momenta {

/// What there is to see, in a sentence or two.
std::string still_words(const Mechanism& mechanism, const Assembly& assembly);

/// @throws std::invalid_argument for a mechanism too large to be drawn
void expect_drawable(const Mechanism& mechanism);

/// The mechanism's picture and the motions of the runs that were filmed; without any, where drives
/// alone take it up to the end of the scene's run (what they leave free stands still), else its
/// start. Meshes are drawn by at most so many bytes. Nothing of a mechanism too large to be drawn.
/// @returns what was left out of the picture, a sentence each
std::vector<std::string> show(StudyResult& study, const Mechanism& mechanism,
                              const Assembly& assembly, std::size_t mesh_bytes = usual_mesh_bytes);

}  // namespace momenta
