#pragma once
// How far two poses of a mechanism are apart, by its mass: ∫ |x − x'|² dm over all bodies, the
// square of the distance in the metric of the kinetic energy where the poses are close. It does not
// depend on how the mechanism is written: joints, cuts, frames, bodies without mass. With c the
// centre of mass and K = ∫ ρρᵀ dm about it, K = ½ tr(I) 1 − I,
//
//   ∫ |x − x'|² dm = m |c − c'|² + tr((R − R') K (R − R')ᵀ)

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>

namespace momenta {

/// ∫ |x − x'|² dm between q and `other` (nq) at time t [s] [kg m²]. O(bodies)
double displacement_of_mass(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& other);

}  // namespace momenta
