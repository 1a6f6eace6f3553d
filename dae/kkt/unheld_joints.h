#pragma once
// Joints that neither inertia nor a loop holds, at a pose: rates v ≠ 0 with
//
//   M v = 0,   Φ_q v = 0.
//
// N, the null space of M, has a column for each lost pivot (core/kernel/massless_joints.h): its
// rate 1, the other lost ones 0, and what joints with inertia do so that no mass moves. Loops leave
// N Y with Φ_q N Y = 0. Unless that is empty, u̇ and σ̇ do not exist, or are not unique.

#include <momenta/core/kernel/massless_joints.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>

namespace momenta {

struct UnheldJoints {
  std::vector<MasslessJoint> joints;  ///< the joints that take part
  Eigen::MatrixXd motions;  ///< N Y (nv × number), independent columns; empty beyond most_pivots
};

/// Unheld joints at (t, q); `loops` false: as if there were none. `known`: a place in u at which a
/// solution failed, −1: none. O((nv + m)³), beyond most_pivots rates O(nv).
UnheldJoints unheld_joints(const Mechanism& mechanism, Evaluation<double>& e, double t,
                           const double* q, bool loops = true, int known = -1);

/// Unheld joints where no solution has failed, as solvers take rounding for inertia. O(n) where
/// every joint's own body has inertia.
UnheldJoints unheld_by_rounding(const Mechanism& mechanism, Evaluation<double>& e, double t,
                                const double* q, bool loops = true);

/// A sentence naming the joints and a motion.
std::string in_words(const Mechanism& mechanism, const UnheldJoints& unheld);

/// "joint 'A' has no inertia without the loops that hold what is on it", for joints that M alone
/// leaves free.
std::string without_loops_in_words(const Mechanism& mechanism,
                                   const std::vector<MasslessJoint>& joints);
/// These words where M is singular at (t, q), exactly or but for rounding; else empty.
std::string mass_without_inverse(const Mechanism& mechanism, Evaluation<double>& e, double t,
                                 const double* q);

/// Solves M x + Φ_qᵀλ = r, Φ_q x = g for x (nv) and λ (m) where `unheld` leaves motions free, e
/// placed at (t, q). There is a solution only where no motion has power, Nᵀr = 0; x has no part
/// along the motions: M + μ N Nᵀ stands for M. Without loops `g` and `lambda` are empty. False: no
/// solution, or too many unknowns to tell. O((nv + m)³)
bool solve_beside(const UnheldJoints& unheld, const Mechanism& mechanism, Evaluation<double>& e,
                  const Eigen::VectorXd& r, const Eigen::VectorXd& g, Eigen::VectorXd& x,
                  Eigen::VectorXd& lambda);

/// Sets entries of x (nv) that the motions leave open to NaN.
void blank(const UnheldJoints& unheld, Eigen::VectorXd& x);

/// Why a solution of (7) failed at (t, q): one sentence naming the joints that neither inertia nor
/// a loop holds, or what solves it where loops hold them. `rate`: the place in u at which it
/// failed; −1: not known. `by_form`: the form has a solver of its own. Cost: as Mechanism::solver()
std::string no_inertia(const Mechanism& mechanism, int rate, double t, const double* q,
                       bool by_form = false);

/// "joint 'A' has no inertia before its loops close", for the joint at place `rate` in u.
std::string light_before_loops(const Mechanism& mechanism, int rate);

}  // namespace momenta
