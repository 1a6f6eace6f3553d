#pragma once
// A moved mechanism as text, CSV and JSON; keys and columns are public interface:
// docs/reference/move.md.

#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/run/picture.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "O.q goes round: 360 poses, back at the start."
std::string move_in_words(const MoveResult& result);

/// Summary, and a table of coordinates.
std::string move_table(const MoveResult& result);

/// A line a pose: kind, displacement of the swept coordinate, branch, coordinates, first and second
/// derivatives, markers; empty cells without derivatives.
std::string move_csv(const MoveResult& result);

nlohmann::ordered_json move_json(const MoveResult& result);

/// Poses at equal travels of the swept coordinate, at most `intervals`.
Film move_film(const MoveResult& result, int intervals);

/// Coordinates over the travel of the swept one, one chart a unit (dae/output/page/timeline.js).
nlohmann::ordered_json move_charts(const MoveResult& result);

}  // namespace momenta
