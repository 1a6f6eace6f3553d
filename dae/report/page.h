#pragma once
// index.html of a study: one file that opens with the network off.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// The page: the conclusion, charts with their tables, the drawing of the mechanism, how it was
/// made. Script, style and uPlot are inlined; the data are the JSON island `<script
/// type="application/json" id="study">`.
std::string drift_page(const StudyResult&);

}  // namespace momenta
