#pragma once
// Figures for papers: SVG with everything inside, no script, black text on white, the colours of
// the pages.

#include <momenta/dae/report/chart.h>
#include <momenta/dae/study/stress_study.h>

#include <string>
#include <vector>

namespace momenta {

struct Figure {
  std::string name;  ///< of its file, without ending
  std::string svg;
};

/// A chart with its axes, its curves (thinned to what can be told apart on paper, extremes kept,
/// every point one of the data), their names at their ends. The head of the plot area tells how to
/// read numbers off: <desc> has the ranges of both axes.
std::string chart_svg(const Chart& chart);

/// Of the one run of a study, of a whole study: the mechanism at its start and all charts of the
/// page.
std::vector<Figure> figures_of_run(const StudyResult&);
std::vector<Figure> figures_of_study(const StudyResult&);
/// Of a stress study: a table of verdicts for each ladder.
std::vector<Figure> figures_of_stress(const StressResult&);

/// The mechanism at a frame of its motion, in its plane or in perspective.
std::string mechanism_svg(const Picture& picture, const Motion::Frame& frame);

}  // namespace momenta
