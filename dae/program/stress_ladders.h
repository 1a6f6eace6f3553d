#pragma once
// The ladders of `momenta stress`: the built-in ladders, and those of a given scene.

#include <momenta/dae/study/stress_study.h>

#include <string>
#include <vector>

namespace momenta::program {

/// Springs, dampers, mass ratios, sizes, speeds and durations to extremes, and scenes that are hard
/// by their nature: redundant, singular, stiff, chaotic, long, or without any motion at all.
std::vector<Ladder> built_in_ladders();

/// One scene along the directions named; empty: all that it has.
/// @throws std::invalid_argument for an unknown name or a direction the scene lacks
std::vector<Ladder> ladders_of(const Scene& scene, const std::vector<std::string>& along);

/// Every form by its own method, and stiff methods where they make a difference.
std::vector<Contestant> usual_contestants();

}  // namespace momenta::program
