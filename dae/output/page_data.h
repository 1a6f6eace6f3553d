#pragma once
// The data island of a page, all that its script draws.

#include <momenta/dae/run/run_result.h>

#include <nlohmann/json.hpp>

namespace momenta {

inline constexpr std::size_t points_per_curve = 400;

/// {scene, scene_file, scene_hash, command, reference, drift_study, plan, environment, palette,
/// histories, picture, motions, csv, runs}; each run is its summary_json with label, ladder_label,
/// tolerance, ladder, sign, growth with half ranges and, if drawn, series {name: {t, y}} of thinned
/// curves to five digits.
nlohmann::ordered_json page_data(const StudyResult&);

/// Curves of a run over time, at common times in a chart: [{key, title, y_title, unit, log, t,
/// curves [{name, y, colour, dash}]}]. Many samples become the least and largest of each stretch,
/// in their order; curves of a unit beyond 24 are left out.
nlohmann::ordered_json timeline_json(const RunResult&);

}  // namespace momenta
