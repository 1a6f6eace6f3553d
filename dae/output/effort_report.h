#pragma once
// Efforts along a motion as text, CSV and JSON; keys and columns are public interface:
// docs/reference/effort.md.

#include <momenta/dae/analysis/effort/effort.h>
#include <momenta/dae/run/picture.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "2 actuators hold the motion of 3 coordinates: …".
std::string effort_in_words(const EffortResult& result);

/// Summary, and a table of actuators.
std::string effort_table(const EffortResult& result);

/// A line a time: t, coordinates, rates, accelerations, efforts, powers, thrusts of helical joints,
/// the sum of powers: also a motion to read.
std::string effort_csv(const EffortResult& result);

nlohmann::ordered_json effort_json(const EffortResult& result);

/// Poses at equal times, at most `intervals`.
Film effort_film(const EffortResult& result, int intervals);

/// Efforts, powers and coordinates over time, one chart a unit (dae/output/page/timeline.js).
nlohmann::ordered_json effort_charts(const EffortResult& result);

}  // namespace momenta
