#pragma once
// The motion of a mechanism in quadruple precision, for references: the acceleration form (3) with
// its state (q, u) projected onto Φ = 0, Φ̇ = 0, by the sweeps with numbers of 113 bits. The
// constants of the model and the drives stay in doubles: the motion is that of a mechanism whose
// lengths and masses differ from those of the scene by rounding.

#include <momenta/core/expression/functions_quad.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <memory>

namespace momenta {

class QuadMotion {
 public:
  virtual ~QuadMotion() = default;
  /// (q̇, u̇) at t [s] and y = (q, u), nq + nv each. False when a joint has no inertia.
  virtual bool rates(double t, const Quad* y, Quad* ydot) = 0;
  /// λ of the last rates(), by row of Φ (m).
  virtual const Quad* multipliers() const = 0;
  /// y onto Φ = 0, Φ̇ = 0 along the mass metric; quaternions to unit length.
  virtual bool project(double t, Quad* y) = 0;
};

/// Makes the motion; a Lagrangian's by make_quad_lagrangian().
/// @pre the mechanism outlives it, unmoved. @throws std::runtime_error where more loop equations
/// are open at once than the sweeps have slots, or a joint is a user joint. Cost of a call: about
/// 100 evaluations in doubles.
std::unique_ptr<QuadMotion> make_quad_motion(const Mechanism& mechanism);

/// The motion of a Lagrangian by its formulas, (3) and its projections by elimination with full
/// pivoting: O((n + m)³) a call. Numbers in formulas are those of the scene, in doubles.
std::unique_ptr<QuadMotion> make_quad_lagrangian(const Mechanism& mechanism);

}  // namespace momenta
