#pragma once
// A chart as data, for pages and for figures of papers.

#include <momenta/dae/report/sign.h>

#include <string>
#include <vector>

namespace momenta {

struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< NaN: a gap
  Sign sign;
  bool failed = false;  ///< a cross at the end
  bool dots = false;    ///< markers at all points
};

struct Chart {
  std::string key;                      ///< file name
  std::string title, x_title, y_title;  ///< axes with their units
  std::string unit;                     ///< y's unit
  bool log_x = false, log_y = false;
  /// For curves that go up and down on a logarithmic axis: the largest value so far is strong, the
  /// value itself faint.
  bool running_maximum = false;
  std::vector<double> slopes;  ///< thin reference lines
  std::vector<Curve> curves;
};

/// Quantities of a study over time, in the order of its page.
struct History {
  const char *key, *title;
  std::string axis, unit;
  std::vector<double> Series::*values;
  std::vector<double> slopes;
};
/// Histories with the run's unit of drift.
std::vector<History> histories(const RunResult& run);

/// Logarithmic charts (drifts, energy error, error), then one for each unit of the trajectory. None
/// is empty.
std::vector<Chart> charts_of_run(const RunResult&);

/// Histories of runs with curves; error against processor time; a ladder's further axes.
std::vector<Chart> charts_of_study(const StudyResult&);

}  // namespace momenta
