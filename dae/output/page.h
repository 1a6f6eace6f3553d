#pragma once
// Text for the places in a page.

#include <momenta/dae/analysis/effort/effort.h>
#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/run/run_result.h>
#include <momenta/dae/study/fit/identification.h>
#include <momenta/dae/study/fit/least.h>
#include <momenta/dae/study/modes_study.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace momenta {

/// Replaces each {{name}} in one pass: braces in replacements are plain text. A name without
/// replacement is removed.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& replacements);

/// & < > " ' as entities.
std::string escape_html(std::string_view text);

// index.html of a study: one file for offline use.

// Script, style and uPlot are inlined; the data are the JSON island `<script
// type="application/json" id="study">`.
/// A study: the conclusion, the mechanism's motion in each run, charts with tables, command and
/// versions.
std::string drift_page(const StudyResult&);

/// The first run: the mechanism moving beside energy, drift and joint curves.
std::string run_page(const StudyResult&);

/// The assembled mechanism, described by `words`.
std::string view_page(const StudyResult&, const std::string& words);

/// The mechanism swinging in one mode at a time, and a table of modes.
std::string modes_page(const StudyResult&, const ModesResult&);

/// Poses beside curves over the travel of the swept coordinate.
std::string move_page(const StudyResult&, const MoveResult&);

/// The mechanism moving beside curves over time.
std::string effort_page(const StudyResult&, const EffortResult&);

/// A fitted mechanism and the one before, moving on top of each other, beside wanted values;
/// `first` of FitPicture.
std::string fit_page(const StudyResult&, const FitResult&, double first);

/// The same, beside formulas of single poses.
std::string least_page(const StudyResult&, const LeastResult&, double first);

/// The runs of both, moving on top of each other, beside measurements.
std::string identification_page(const StudyResult&, const Identification&);

// Pages without script: a title, an answer, sections.

/// A section under its title; `inside` is HTML.
std::string section(const std::string& title, const std::string& inside);
/// A table as printed.
std::string preformatted(const std::string& text);
/// A chart at its size; narrower windows scroll it.
std::string drawn(const std::string& svg);
/// Command, versions, compiler, processor and date.
std::string how_section(const Environment& environment, const std::string& command);
/// `kind`: one word beside the program's name; `answer` and `main` are HTML.
std::string plain_page(const std::string& title, const char* kind, const std::string& answer,
                       const std::string& main);

}  // namespace momenta
