#pragma once
// The index of each form, as text for the terminal and as index.json. Keys are public interface.

#include <momenta/dae/study/index_study.h>

#include <nlohmann/json.hpp>

namespace momenta {

/// A table, then for each form its constraints in order and what IDA may assume, then why λ makes
/// one index more than σ where the study has both.
std::string index_table(const IndexStudy&);

nlohmann::ordered_json index_json(const IndexStudy&);

/// "4 2 0": one number for each level of the array.
std::string over_levels(const IndexFound&, int ArrayLevel::*number);
/// Smallest gap of all ranks; 0 without levels.
double smallest_gap(const IndexFound&);
/// One object a level.
nlohmann::ordered_json levels_json(const IndexFound&);

}  // namespace momenta
