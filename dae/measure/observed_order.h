#pragma once
// The observed order of a method: how fast an error falls with the number of steps,
//
//   error ∝ steps^(−r),
//
// r by least squares of the logarithms over a ladder of steps or tolerances. Of methods with error
// control the number of steps stands for the inverse of their mean length.

#include <momenta/dae/measure/growth.h>

#include <vector>

namespace momenta {

/// An observed order.
struct ObservedOrder {
  double order = not_measured;       ///< r; NaN: fewer than three rungs show it
  double half_range = not_measured;  ///< half the spread of the slopes of sub-ladders
  int rungs = 0;                     ///< of the fit
};

/// The order that errors (1) of runs with so many steps show, steps ascending. The fit takes the
/// rungs whose error is below 0.1, the least included and none behind it: those are rounding. NaN
/// errors are left out. The half-range is half the spread of the slopes of the two halves and of
/// the whole.
ObservedOrder observed_order(const std::vector<double>& steps, const std::vector<double>& errors);

}  // namespace momenta
