#pragma once
// index.html of a study: one file for offline use.

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

}  // namespace momenta
