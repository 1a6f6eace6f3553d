#pragma once
// The observed order of a method: how fast an error falls with the number of steps,
//
//   error ∝ steps^(−r),
//
// r by least squares of the logarithms over a ladder of steps or tolerances. With error control the
// number of steps stands for the inverse of their mean length.

#include <momenta/dae/measure/growth.h>

#include <vector>

namespace momenta {

struct ObservedOrder {
  double order = not_measured;       ///< r; NaN: fewer than three rungs
  double half_range = not_measured;  ///< half the spread of slopes: ladder and halves
  int rungs = 0;                     ///< rungs in the fit
};

/// The order from errors (1) of runs with ascending numbers of steps. The fit takes rungs with an
/// error below 0.1, up to the least: later ones are rounding. NaN errors are left out.
ObservedOrder observed_order(const std::vector<double>& steps, const std::vector<double>& errors);

}  // namespace momenta
