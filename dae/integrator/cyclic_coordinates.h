#pragma once
// Cyclic coordinates: H and Φ do not depend on them, no force acts along them, so their momenta are
// constants of the motion, such as the momentum about the vertical axis of a turntable. L_q + Q and
// Φ_qᵀx are analytic but for stops: what is zero at random states is zero everywhere, with
// probability one.

#include <momenta/dae/integrator/constrained_hamiltonian.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

/// Places in p, ascending; judged by some states within 1 rad, 1 m of q and a second of t.
std::vector<int> cyclic_coordinates(ConstrainedHamiltonian& parts, double t,
                                    const Eigen::VectorXd& q);

}  // namespace momenta
