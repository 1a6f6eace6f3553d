#pragma once
// Figures for papers: self-contained SVG without script, black text on white, the pages' colours.

#include <momenta/dae/report/chart.h>
#include <momenta/dae/study/stress_study.h>

#include <string>
#include <vector>

namespace momenta {

struct Figure {
  std::string name;  ///< file name without ending
  std::string svg;
};

/// Axes and curves, named at their ends and thinned to visible points of the data, extremes kept.
/// <desc> has the ranges of both axes.
std::string chart_svg(const Chart& chart);

/// The mechanism at its start and the page's charts.
std::vector<Figure> figures_of_run(const StudyResult&);
std::vector<Figure> figures_of_study(const StudyResult&);
/// A table of verdicts a ladder.
std::vector<Figure> figures_of_stress(const StressResult&);

/// The mechanism at a frame of its motion, in its plane or in perspective.
std::string mechanism_svg(const Picture& picture, const Motion::Frame& frame);

}  // namespace momenta
