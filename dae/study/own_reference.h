#pragma once
// A reference solution made by the program itself. Its form and integrator differ from those that
// it judges: the acceleration form, projected at every step, with extrapolation in quadruple
// precision. A second solution with a looser tolerance gives an estimate of its error.
//
// Where an explicit method in doubles finds the motion stiff (solver/stiffness.h), steps of the
// extrapolated midpoint rule would be held by its stability, 10⁵ evaluations a second of motion and
// more; there Radau's method of order 17 takes its place (solver/radau_collocation.h).

#include <momenta/dae/form/form.h>
#include <momenta/dae/measure/reference.h>

#include <functional>
#include <string>

namespace momenta {

struct OwnReference {
  Reference reference;
  double accuracy = 0;    ///< largest distance of the two solutions, as errors are measured
  bool implicit = false;  ///< stiff motion: made by the implicit method
};

/// Joint coordinates, rates and multipliers λ at `count` equal intervals up to `end` [s], bound to
/// measured_columns(). With `forces` also ∫λ dt, integrated beside q and u, where the loop
/// equations are independent at the start; and efforts, reactions, momenta and work
/// (own_reference_forces.h). `going_on` (may be empty) takes the time reached; false stops. @throws
/// std::runtime_error with one sentence without a solution.
OwnReference own_reference(const Mechanism& mechanism, const Start& start, double end, int count,
                           const std::function<bool(double t)>& going_on = {}, bool forces = false);

/// "quadruple precision: acceleration form …; two tolerances agree to 2e-17"
std::string in_words(const OwnReference& own);

}  // namespace momenta
