#pragma once
// A pose at which the mechanism stays when released at rest:
//
//   r(q) + Φ_qᵀλ = 0,   Φ(q) = 0          r: (1a) at u = u̇ = 0
//
// Test of a pose: λ and u̇ are those of (3) at rest, and M u̇ is the force left. With running drives
// it is a relative equilibrium, of V − T₀ with T₀ the kinetic energy of prescribed motion alone.
//
// Each step solves, with the exact second derivatives K of V + λ·Φ,
//
//   ( K + μM  Φ_qᵀ ) ( δ )   ( −r − Φ_qᵀλ )
//   ( Φ_q     0    ) ( ν ) = (  0         ),    q ← q ∘ exp δ,  then back to Φ = 0
//
//   settle    μ falls while V − T₀ falls as K foretells and rises when it does not: implicit steps
//             of length 1/μ of the gradient flow M q̇ = −∇(V − T₀), which ends as Newton's method
//             (pseudo-transient continuation: Kelley, Keyes, SIAM J. Numer. Anal. 35 (1998) 508).
//             Saddles on the way are left (negative_curvature.h). Of forces without a potential it is the
//             work of all forces on the way that counts, in place of the fall of V − T₀.
//   nearest   Newton's method, μ = 0, steps halved until the forces left fall: it ends at any kind
//             of equilibrium, a saddle too.
//   start     no step: the pose is one, or is refused.
//   steady    none is looked for: the start's rates are those of a steady motion (steady_motion.h).

#include <momenta/dae/form/form.h>

#include <string>

namespace momenta {

enum class Search { settle, nearest, start, steady };

struct Equilibrium {
  double t = 0;
  Eigen::VectorXd q, lambda;  ///< nq; m, one choice of the loops' forces
  int steps = 0;
  double left = 0;   ///< largest, relative to the forces on its joint
  double moved = 0;  ///< largest change of a coordinate since the start [rad or m]
  double last_step = 0;
  double potential = 0;  ///< V [J]
  double pivot = 0;      ///< singular values of Φ_q above it count
};

/// Starts from a consistent pose at any rates. `settle` leaves a saddle that it came to, not one
/// that it started at.
/// @throws SceneError with the joint of the largest force left, or the drive that does not allow
/// rest.
Equilibrium find_equilibrium(const Mechanism& mechanism, const Start& start, Search search);

/// The same from a pose moved by `way` (nv), back on Φ = 0.
Equilibrium settle_from(const Mechanism& mechanism, const Equilibrium& saddle,
                        const Eigen::VectorXd& way);

/// Whether all forces have a potential: no wrench that turns with a body, no constant torque in
/// space.
bool has_potential(const Mechanism& mechanism);

/// Natural size of each rate's force (nv) at the placed pose at rest, for rounding and residuals [N
/// m or N].
Eigen::VectorXd force_scales(const Mechanism& mechanism, Evaluation<double>& e);

/// 1 for turns, the length of the scene for shifts (nv).
Eigen::VectorXd natural_units(const Mechanism& mechanism);

}  // namespace momenta
