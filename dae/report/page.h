#pragma once
// index.html of a study: one file that opens with the network off.

#include <momenta/dae/study/run_result.h>

#include <string>
#include <string_view>

namespace momenta {

/// The page: the conclusion, charts with their tables, the drawing of the mechanism, how it was
/// made. Script, style and uPlot are inlined; the data are the JSON island `<script
/// type="application/json" id="study">`.
std::string drift_page(const StudyResult&);

/// & < > " ' as entities.
std::string escape_html(std::string_view text);

}  // namespace momenta
