#pragma once
// Dry friction of a joint by the force in its bearing (docs/theory/friction.md).

namespace momenta {

/// The bearing of a revolute joint, a journal, or of a prismatic one, a slider. With N the force
/// across the axis and v the sliding speed, friction is N μ(v) against the motion,
///
///   μ(v) = μ_d tanh(4 x) + (μ_s − μ_d) x / (x²/4 + 3/4)²,   x = v / v_t
///
/// (Brown and McPhee, ASME J. Comput. Nonlinear Dyn. 11 (2016) 054502), largest near v_t.
/// Prismatic: v = u. Revolute: v = r u, and N μ(v) has the arm r.
struct BearingSpec {
  double static_friction = 0;         ///< μ_s, at least μ_d
  double dynamic_friction = 0;        ///< μ_d, at least 0
  double transition_velocity = 0.01;  ///< v_t [m/s], > 0
  double radius = 0;                  ///< revolute: r of the pin [m], > 0
  /// Distance along the axis [m] of two equal bearings on either side of the joint's point of the
  /// child, which carry the moment across the axis too. 0: one bearing, which carries none.
  double length = 0;
};

}  // namespace momenta
