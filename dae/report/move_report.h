#pragma once
// A moved mechanism as text, CSV and JSON; keys and columns are public interface:
// docs/reference/move.md.

#include <momenta/dae/kinematics/move.h>
#include <momenta/dae/study/picture.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "O.q goes round: 360 poses, back at the start.": what there is to know first.
std::string move_in_words(const MoveResult& result);

/// What each coordinate does, as a table, with those words above it.
std::string move_table(const MoveResult& result);

/// A line a pose: kind, displacement of the swept coordinate, branch, coordinates, their first and
/// second derivatives, markers; empty cells where there are no derivatives.
std::string move_csv(const MoveResult& result);

nlohmann::ordered_json move_json(const MoveResult& result);

/// The poses at equal travels of the swept coordinate, at most so many intervals.
Film move_film(const MoveResult& result, int intervals);

/// Curves of coordinates over the travel of the swept one, one chart for each unit, as pages have
/// them (dae/report/page/timeline.js).
nlohmann::ordered_json move_charts(const MoveResult& result);

}  // namespace momenta
