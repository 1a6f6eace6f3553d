#pragma once
// An axis of a chart: its range, its ticks and their names.

#include <limits>
#include <string>
#include <vector>

namespace momenta {

/// What values span.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double value);
  bool empty() const { return !(low <= high); }
};

struct Axis {
  bool log;
  double low, high, length;  ///< values at both ends; pixels between them

  /// Pixels from the low end to a value.
  double at(double value) const;
  /// Round values, at least about `apart` pixels from each other: 1, 2 or 5 times a power of ten.
  std::vector<double> ticks(double apart) const;
  /// Of a tick: "10⁻³", "2·10⁻³", "0.25".
  std::string name(double value) const;
  /// "title from 0 to 1, linear".
  std::string words(const std::string& title) const;
};

/// An axis of that many pixels around the data: `whole` decades of a logarithmic one, a little room
/// on a linear one; otherwise to the data's ends.
Axis axis_around(Range range, bool log, bool whole, double length);

}  // namespace momenta
