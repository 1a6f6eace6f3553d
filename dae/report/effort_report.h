#pragma once
// Efforts along a motion as text, CSV and JSON; keys and columns are public interface:
// docs/reference/effort.md.

#include <momenta/dae/effort/effort.h>
#include <momenta/dae/study/picture.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "2 actuators hold the motion of 3 coordinates: …": what there is to know first.
std::string effort_in_words(const EffortResult& result);

/// What each actuator does, as a table, with those words above it.
std::string effort_table(const EffortResult& result);

/// A line a time: t, coordinates, rates, accelerations, efforts, powers, thrusts of helical joints,
/// the sum of powers. Its coordinates, rates and accelerations are a motion that can be read again.
std::string effort_csv(const EffortResult& result);

nlohmann::ordered_json effort_json(const EffortResult& result);

/// The motion at equal times, at most so many intervals.
Film effort_film(const EffortResult& result, int intervals);

/// Efforts, powers and coordinates over time, one chart for each unit, as pages have them
/// (dae/report/page/timeline.js).
nlohmann::ordered_json effort_charts(const EffortResult& result);

}  // namespace momenta
