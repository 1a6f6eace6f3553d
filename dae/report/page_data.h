#pragma once
// The data island of a page: everything its script draws, and nothing else.

#include <momenta/dae/study/run_result.h>

#include <nlohmann/json.hpp>

namespace momenta {

/// Most points that one curve of a page has.
inline constexpr std::size_t points_per_curve = 400;

/// {scene, scene_file, scene_hash, command, reference, drift_study, plan, environment, palette,
/// histories, picture, motions, csv, runs}; each run is its summary_json with label, ladder_label,
/// tolerance, ladder, sign, growth with half ranges and, where its history is drawn, series {name:
/// {t, y}} of thinned curves to five digits.
nlohmann::ordered_json page_data(const StudyResult&);

/// Curves of a run over time, those of one chart at common times: [{key, title, y_title, unit, log,
/// t, curves [{name, y, colour, dash}]}]. More samples than a chart is wide become the least and
/// the largest of each stretch, in their order; more than 24 curves of a unit are left out.
nlohmann::ordered_json timeline_json(const RunResult&);

}  // namespace momenta
