#pragma once
// What a run is called in a table, a sentence or at the end of a curve: as short as keeps it unique
// in its study.

#include <momenta/dae/study/run_result.h>

#include <string>
#include <vector>

namespace momenta {

/// One label per run: the form, then those settings (integrator, gauge, tolerance or step,
/// projection, way of solving (7)) in which runs of that form differ: "momentum", "momentum,
/// dop853, leak:10", "acceleration, 1e-6".
/// Without the tolerance it is the name of a ladder.
std::vector<std::string> run_labels(const StudyResult&, bool with_tolerance = true);

/// "1e-8" where rtol = atol, "1e-8/1e-10" where not, "h = 0.005 s" of a fixed step.
std::string tolerance_text(const RunSettings&);

/// The runs whose histories are drawn: every run of a drift study; of a ladder the first rung of
/// each form, integrator, gauge and projection. Indices into StudyResult::runs, ascending.
std::vector<std::size_t> runs_with_curves(const StudyResult&);

/// Index of the first run of the same form, integrator, gauge and projection: one ladder of a work
/// study.
std::vector<std::size_t> ladders(const StudyResult&);

}  // namespace momenta
