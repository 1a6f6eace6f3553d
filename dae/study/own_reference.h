#pragma once
// A reference solution made by the program itself. Its form and integrator differ from those that
// it judges: the acceleration form, projected at every step, with extrapolation in quadruple
// precision. A second solution with a looser tolerance gives an estimate of its error.

#include <momenta/dae/form/form.h>
#include <momenta/dae/measure/reference.h>

#include <functional>

namespace momenta {

struct OwnReference {
  Reference reference;
  double accuracy = 0;  ///< largest distance of the two solutions, as errors are measured
};

/// Joint coordinates and rates at `count` equal intervals up to `end` [s], bound to the mechanism's
/// trajectory. `going_on` (may be empty) is told the time reached; false ends it.
/// @throws std::runtime_error with one sentence when there is no such solution.
OwnReference own_reference(const Mechanism& mechanism, const Start& start, double end, int count,
                           const std::function<bool(double t)>& going_on = {});

}  // namespace momenta
