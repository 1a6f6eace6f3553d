#pragma once
// An identified mechanism as text, CSV and JSON; keys and columns are public interface:
// docs/reference/fit.md.

#include <momenta/dae/study/fit/identification.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "Of 400 numbers measured at 200 times the rms error is 0.0019 rad; …".
std::string identification_in_words(const Identification& result);

/// Summary, and parameters before and after with standard deviations.
std::string identification_table(const Identification& result);

/// A line a time: t, and for each quantity the measured, found and given values; empty cells
/// without a measurement or run.
std::string identification_csv(const Identification& result);

nlohmann::ordered_json identification_json(const Identification& result);

/// The same over time, one chart a quantity (dae/output/page/timeline.js).
nlohmann::ordered_json identification_charts(const Identification& result);

}  // namespace momenta
