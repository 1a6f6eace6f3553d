#pragma once
// A chart as data, for pages and for figures of papers.

#include <momenta/dae/output/run_label.h>

#include <limits>
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

// An axis of a chart: its range, its ticks and their names.

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double value);
  bool empty() const { return !(low <= high); }
};

struct Axis {
  bool log;
  double low, high, length;  ///< values at both ends; pixels between them

  double at(double value) const;
  /// Round values, about `apart` pixels or more from each other: 1, 2 or 5 times a power of ten.
  std::vector<double> ticks(double apart) const;
  /// "10⁻³", "2·10⁻³", "0.25".
  std::string name(double value) const;
  /// "title from 0 to 1, linear".
  std::string words(const std::string& title) const;
};

/// An axis of `length` pixels around the data: `whole` decades if logarithmic, a little room if
/// linear; otherwise to the data's ends.
Axis axis_around(Range range, bool log, bool whole, double length);

// Markers of a chart's points, as SVG.

/// A circle, square, triangle, diamond, plus or star about (x, y), r in size [px]; else a square.
std::string marker(const std::string& kind, double x, double y, double r, const std::string& fill);

/// Sign of a failed run.
std::string cross_at(double x, double y);

}  // namespace momenta
