#pragma once
// Index of each form, as text for the terminal and as index.json. Keys are public interface.

#include <momenta/dae/study/index_study.h>

#include <nlohmann/json.hpp>

namespace momenta {

/// A table, then constraints of each form and assumptions for IDA, then why λ makes one index more
/// than σ if the study has both.
std::string index_table(const IndexStudy&);

nlohmann::ordered_json index_json(const IndexStudy&);

/// Numbers by level of the array: "4 2 0".
std::string over_levels(const IndexFound&, int ArrayLevel::*number);
/// Least gap of all ranks; 0 without levels.
double smallest_gap(const IndexFound&);
/// One object a level.
nlohmann::ordered_json levels_json(const IndexFound&);

}  // namespace momenta
