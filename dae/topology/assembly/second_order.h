#pragma once
// Motions that loops allow to second order, at a pose where their equations lose rank.
//
// To first order rates u = V y are free, Φ_q V = 0. Let ω be a force of the loops that moves
// nothing, ωᵀΦ_q = 0. Along a motion that begins with s V y, or with a higher power of s in place
// of it, whatever follows,
//
//   ω·Φ = s² F(y) / 2 + …,    F(y) = ω·Φ_qq[V y, V y],
//
// so a motion has F_i(y) = 0 for all ω_i. Of redundant equations F is zero. Two stretched rods have
// one y and F ≠ 0, a flat parallelogram has two and F of both signs: it moves along the lines where
// F is zero.
//
// Where a combination Σ c_i F_i is zero or more everywhere, motions have it zero; where it is more
// than zero for all y but those, none goes another way (prestress stability). If besides no y at
// all has F_i(y) = 0, the pose is rigid to second order, and so it is rigid.
//
// Loops that move with time, and equations of velocities, say nothing here.
// Source: Connelly and Whiteley, Second-order rigidity and prestress stability for tensegrity
// frameworks, SIAM J. Discrete Math. 9 (1996) 453.

#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <string>

namespace momenta {

struct Rigidity {
  Eigen::VectorXd stuck;  ///< rates (nv) free to first order that no motion has; empty: none found
  bool certain = true;    ///< a form proves it; false: no such motion was found
  bool all = false;       ///< no y with F_i(y) = 0 was found but where all forms are zero
  Eigen::Index flat = 0;  ///< independent y where all forms are zero
  int row = 0;            ///< row of Φ that opens most along them
};

/// Rigidity at (t, q), where the equations of positions have rank `rank` in all rates, less than
/// their number. Nothing is found beyond 10⁵ entries of Φ_q, 60 free rates, or 12 of them that the
/// forms depend on. O((n + m)³)
Rigidity second_order(ScaledLoops& loops, double t, const Eigen::VectorXd& q, int rank);

/// "at A.u = 1, B.u = -2 …", what is stuck and by which loop.
std::string in_words(const Mechanism& mechanism, const Rigidity& found);

}  // namespace momenta
