#pragma once
// Parameters for which a functional is least, as text, CSV and JSON; keys and columns are public
// interface: docs/reference/fit.md.

#include <momenta/dae/study/fit/least.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "max(P.y) is 1.2; as the scene is, 3.4. A minimum, of one start."
std::string least_in_words(const LeastResult& result);

/// Summary, a table of parameters before and after, and conditions.
std::string least_table(const LeastResult& result);

/// A line a pose of a swept motion: the swept coordinate, and formulas of single poses before and
/// after; else the header alone.
std::string least_csv(const LeastResult& result);

nlohmann::ordered_json least_json(const LeastResult& result);

/// Formulas of single poses over the swept coordinate from `first` (dae/output/page/timeline.js).
nlohmann::ordered_json least_charts(const LeastResult& result, double first);

}  // namespace momenta
