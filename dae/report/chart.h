#pragma once
// A chart as data: what a page draws and what a figure for a paper is made of.

#include <momenta/dae/report/sign.h>

#include <string>
#include <vector>

namespace momenta {

struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< NaN: nothing there
  Sign sign;
  bool failed = false;  ///< a cross where it ends
  bool dots = false;    ///< a marker at each point
};

struct Chart {
  std::string key;                      ///< of its file
  std::string title, x_title, y_title;  ///< axes with their units
  std::string unit;                     ///< of y
  bool log_x = false, log_y = false;
  /// Of curves that go up and down on a logarithmic axis: strong the largest value so far, faint
  /// the value itself.
  bool running_maximum = false;
  std::vector<double> slopes;  ///< of thin lines of reference
  std::vector<Curve> curves;
};

/// Quantities of a study over time, in the order of its page.
struct History {
  const char *key, *title;
  std::string axis, unit;
  std::vector<double> Series::*values;
  std::vector<double> slopes;
};
/// With the unit that the drifts of this run have.
std::vector<History> histories(const RunResult& run);

/// Of one run over time: what is logarithmic (drifts, energy error, error), then a chart for each
/// unit of its trajectory. Empty charts are left out.
std::vector<Chart> charts_of_run(const RunResult&);

/// Histories of the runs that have curves; then error against processor time and, of a ladder, its
/// further axes.
std::vector<Chart> charts_of_study(const StudyResult&);

}  // namespace momenta
