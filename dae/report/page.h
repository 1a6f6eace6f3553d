#pragma once
// index.html of a study: one file that opens with the network off.

#include <momenta/dae/effort/effort.h>
#include <momenta/dae/fit/identification.h>
#include <momenta/dae/fit/least.h>
#include <momenta/dae/kinematics/move.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

// Script, style and uPlot are inlined; the data are the JSON island `<script
// type="application/json" id="study">`.
/// Of a study: the conclusion, the mechanism as each run moved it, charts with their tables, how it
/// was made.
std::string drift_page(const StudyResult&);

/// Of its first run: the mechanism moving beside energy, drift and joint curves, with one time.
std::string run_page(const StudyResult&);

/// Of a scene without runs: the mechanism as it is assembled; `words` say what it is.
std::string view_page(const StudyResult&, const std::string& words);

/// Of an equilibrium: the mechanism swinging in one mode at a time, and all modes as a table.
std::string modes_page(const StudyResult&, const ModesResult&);

/// Of a mechanism that is moved: its poses beside curves over the travel of the swept coordinate.
std::string move_page(const StudyResult&, const MoveResult&);

/// Of efforts along a motion: the mechanism moving beside their curves over time.
std::string effort_page(const StudyResult&, const EffortResult&);

/// Of a fitted mechanism: it and the one before, moving on top of each other, beside what is
/// wanted; `first` of FitPicture.
std::string fit_page(const StudyResult&, const FitResult&, double first);

/// Of a mechanism whose functional is least: the same, beside the formulas of single poses.
std::string least_page(const StudyResult&, const LeastResult&, double first);

/// Of a mechanism identified: its run and the one before, moving on top of each other, beside what
/// was measured.
std::string identification_page(const StudyResult&, const Identification&);

}  // namespace momenta
