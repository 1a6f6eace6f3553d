#pragma once
// An identified mechanism as text, CSV and JSON; keys and columns are public interface:
// docs/reference/fit.md.

#include <momenta/dae/fit/identification.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "Of 400 numbers measured at 200 times the rms error is 0.0019 rad; …": what there is to know
/// first.
std::string identification_in_words(const Identification& result);

/// Parameters before and after with their standard deviations, with those words above them.
std::string identification_table(const Identification& result);

/// A line a time: t, and of each quantity what was measured, what the scene found does, and what
/// the scene as it is does; empty cells where nothing was measured, or there is no such run.
std::string identification_csv(const Identification& result);

nlohmann::ordered_json identification_json(const Identification& result);

/// The same over time, one chart a quantity, as pages have them (dae/report/page/timeline.js).
nlohmann::ordered_json identification_charts(const Identification& result);

}  // namespace momenta
