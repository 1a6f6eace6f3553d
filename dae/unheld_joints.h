#pragma once
// Joints that neither inertia nor a loop holds, at a pose: rates v ≠ 0 with
//
//   M v = 0,   Φ_q v = 0.
//
// The null space of M has a column for each lost pivot (core/massless_joints.h): that rate 1, the
// others of them 0, and what those with inertia do that nothing moves. Of these the loops leave Y
// with Φ_q N Y = 0. Where there is one, u̇ and σ̇ do not exist, or are not unique.

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

/// The same where nothing has failed: solvers take for inertia what rounding leaves of none. O(n)
/// where every joint's own body has some.
UnheldJoints unheld_by_rounding(const Mechanism& mechanism, Evaluation<double>& e, double t,
                                const double* q, bool loops = true);

/// The sentence that names them and a motion.
std::string in_words(const Mechanism& mechanism, const UnheldJoints& unheld);

/// "joint 'A' has no inertia without the loops that hold what is on it", of those that M alone
/// leaves free.
std::string without_loops_in_words(const Mechanism& mechanism,
                                   const std::vector<MasslessJoint>& joints);
/// The same where M has no inverse at (t, q), by its factors or but for rounding; else empty.
std::string mass_without_inverse(const Mechanism& mechanism, Evaluation<double>& e, double t,
                                 const double* q);

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
