#pragma once
// A fitted mechanism as text, CSV and JSON; keys and columns are public interface:
// docs/reference/fit.md.

#include <momenta/dae/fit/fit.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "The largest error of 24 poses is 1.2 µm; as the scene is, 31 mm.": what there is to know first.
std::string fit_in_words(const FitResult& result);

/// Parameters before and after as a table, with those words above it.
std::string fit_table(const FitResult& result);

/// A line a pose: the swept coordinate, and of each quantity what is wanted, what the scene found
/// does, and what the scene as it is does; empty cells where nothing is asked, or not reached.
std::string fit_csv(const FitResult& result);

nlohmann::ordered_json fit_json(const FitResult& result);

/// What is wanted, what the mechanism found does and what the one before does, pose by pose over
/// the way of the swept coordinate from `first`, one chart a quantity, as pages have them
/// (dae/report/page/timeline.js).
nlohmann::ordered_json fit_charts(const FitResult& result, double first);

}  // namespace momenta
