#pragma once
// (7)-(8) and (3) of a mechanism with loops in quadruple precision: the sweeps themselves on
// another scalar, so that what differs is rounding alone. That the sweeps are right is for the
// tests to say.

#include <momenta/dae/mechanism/mechanism.h>

namespace momenta {

struct LoopedRates {
  Eigen::VectorXd u, pdot, udot;
};

/// u and ṗ at (q, p), u̇ at (q, v), joint forces of springs and wrenches left out. `fade` 0: nothing
/// is faded, and rows must be independent.
LoopedRates quad_rates(const Mechanism& mechanism, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& p, const Eigen::VectorXd& v, double leak,
                       double fade);

}  // namespace momenta
