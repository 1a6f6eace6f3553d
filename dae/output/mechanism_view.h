#pragma once
// A mechanism on pages: in words, at its start, and moving in its runs.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/output/meshes.h>
#include <momenta/dae/run/run_result.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <string>
#include <vector>

namespace momenta {

/// The mechanism in a sentence or two.
std::string still_words(const Mechanism& mechanism, const Assembly& assembly);

/// @throws std::invalid_argument for too large a mechanism
void expect_drawable(const Mechanism& mechanism);

/// The mechanism's picture and the filmed motions; without any, the motion by drives up to the end
/// of the scene's run (free coordinates stand still), else its start. Meshes take at most
/// `mesh_bytes`. Nothing for a mechanism too large to be drawn.
/// @returns a sentence for each part left out of the picture
std::vector<std::string> show(StudyResult& study, const Mechanism& mechanism,
                              const Assembly& assembly, std::size_t mesh_bytes = usual_mesh_bytes);

}  // namespace momenta
