#pragma once
// Reach of drives, in words of `momenta check`.

#include <momenta/dae/assembly/drive_reach.h>
#include <momenta/dae/cut/recut.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta::program {

/// Whether there are drives beside loops.
bool has_reach(const Mechanism& mechanism);
/// One line.
std::string in_words(const DriveReach& reach, double end);
nlohmann::ordered_json reach_json(const DriveReach& reach);

// Savings of other cut joints, in words.

/// One sentence.
std::string cuts_in_words(const Recut& recut);

}  // namespace momenta::program
