#pragma once
// Joints that neither inertia nor a loop holds, at a pose: rates v ≠ 0 with
//
//   M v = 0,   Φ_q v = 0.
//
// The null space of M has a column for each lost pivot (core/massless_joints.h): that rate 1, the
// others of them 0, and what those with inertia do that nothing moves, M_rr v_r = −M_rz. Of these
// the loops leave Y with Φ_q N Y = 0. Where there is one, u̇ and σ̇ do not exist, or are not unique.

#include <momenta/core/massless_joints.h>
#include <momenta/dae/mechanism.h>

#include <Eigen/Core>

namespace momenta {

struct UnheldJoints {
  std::vector<MasslessJoint> joints;  ///< those that take part
  Eigen::MatrixXd motions;  ///< N Y (nv × number), independent columns; empty beyond most_pivots
};

/// At (t, q); `loops` false: as if no loop were there. `known`: a place in u at which a solution
/// failed, −1: none. O((nv + m)³), of more than most_pivots rates O(nv).
UnheldJoints unheld_joints(const Mechanism& mechanism, Evaluation<double>& e, double t,
                           const double* q, bool loops = true, int known = -1);

/// x (nv) and λ (m) of M x + Φ_qᵀλ = r, Φ_q x = g where `unheld` leaves motions free, e placed at
/// (t, q). There is one only where no motion has power, Nᵀr = 0: then of x that without a part of
/// the motions, what solves with μ N Nᵀ beside M. Without loops `g` and `lambda` are empty. False:
/// there is none, or too many unknowns to tell. O((nv + m)³)
bool solve_beside(const UnheldJoints& unheld, const Mechanism& mechanism, Evaluation<double>& e,
                  const Eigen::VectorXd& r, const Eigen::VectorXd& g, Eigen::VectorXd& x,
                  Eigen::VectorXd& lambda);

/// Entries of x (nv) that these motions leave open become NaN.
void blank(const UnheldJoints& unheld, Eigen::VectorXd& x);

}  // namespace momenta
