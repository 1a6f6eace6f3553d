#pragma once
// A fitted mechanism as text, CSV and JSON; keys and columns are public interface:
// docs/reference/fit.md.

#include <momenta/dae/study/fit/fit.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "The largest error of 24 poses is 1.2 µm; as the scene is, 31 mm."
std::string fit_in_words(const FitResult& result);

/// Summary, and a table of parameters before and after.
std::string fit_table(const FitResult& result);

/// A line a pose: the swept coordinate, and for each quantity the wanted, found and given values;
/// empty cells where none is wanted or reached.
std::string fit_csv(const FitResult& result);

nlohmann::ordered_json fit_json(const FitResult& result);

/// The same over the swept coordinate from `first`, one chart a quantity
/// (dae/output/page/timeline.js).
nlohmann::ordered_json fit_charts(const FitResult& result, double first);

}  // namespace momenta
