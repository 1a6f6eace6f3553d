#pragma once
// Ladders of `momenta stress`, built-in and for a given scene.

#include <momenta/dae/study/stress_study.h>

#include <string>
#include <vector>

namespace momenta::program {

/// Springs, dampers, mass ratios, sizes, speeds and durations to extremes, and difficult scenes:
/// redundant, singular, stiff, chaotic, long, or without any motion.
std::vector<Ladder> built_in_ladders();

/// Ladders of one scene in the directions named; empty: in all.
/// @throws std::invalid_argument for an unknown name or a direction the scene lacks
std::vector<Ladder> ladders_of(const Scene& scene, const std::vector<std::string>& along);

/// Every form by its own method, and stiff methods where they make a difference.
std::vector<Contestant> usual_contestants();

}  // namespace momenta::program
