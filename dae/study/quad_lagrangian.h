#pragma once
#include <momenta/dae/study/quad_motion.h>

namespace momenta {

/// The motion of a Lagrangian by its formulas, (3) and its projections by elimination with full
/// pivoting: O((n + m)³) a call. Numbers in formulas are those of the scene, in doubles.
std::unique_ptr<QuadMotion> make_quad_lagrangian(const Mechanism& mechanism);

}  // namespace momenta
