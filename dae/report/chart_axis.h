#pragma once
// An axis of a chart: its range, its ticks and their names.

#include <limits>
#include <string>
#include <vector>

namespace momenta {

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

}  // namespace momenta
