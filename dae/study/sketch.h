#pragma once
#include <momenta/dae/mechanism.h>
#include <momenta/dae/study/run_result.h>

namespace momenta {

/// The mechanism at (t, q), seen along the plane's normal, or obliquely when it moves in space:
/// every body as the line or polygon through its joints, loop ends and rod tips.
Sketch sketch(const Mechanism& mechanism, double t, const Eigen::VectorXd& q);

}  // namespace momenta
