#pragma once
// A reference solution made by the program itself: form and integrator differ from those it judges
// (acceleration form projected at every step, extrapolation in quadruple precision), and a second
// solution with a looser tolerance tells how far it can be trusted.

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
