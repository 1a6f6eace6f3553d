#pragma once
// Joints that no inertia holds: rates v ≠ 0 with M v = 0. M is positive semidefinite, so where a
// pivot of
//
//   M = Lᵀ D L,    tips first,
//
// is lost, what is left of its row is lost with it, and elimination goes on without it. Each lost
// pivot is a joint whose articulated inertia is zero: either its subtree has no inertia along it,
// M_jj = 0, or the joints it carries move alone what has some.
//
// A pivot is twice the least energy of a motion x with that rate 1 and those further in 0,
//
//   d_k = min xᵀM x,    of terms of the size s_i = Σ (tr I + m r²) or Σ m, over all that joint i
//                       carries, r its arms as if stretched out,
//
// and it is rounding alone where d_k ≤ 64 ε (Σ |x_i| √s_i)². The test compares with the terms of
// the energy in the weakest direction, so it does not depend on axes, units or other joints:
// without inertia rounding leaves 10⁻¹⁶ of them, of either sign.
//
// d_k is at least the inertia of the joint's own body along it. Where each has some, none is lost.

#include <momenta/core/kernel/tree/tree.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

struct MasslessJoint {
  int rate;                ///< place in u
  bool weightless;         ///< M_jj = 0; else other joints can move alone what has inertia
  Eigen::VectorXd motion;  ///< x (nv), M x = 0; empty: M is not known
};

/// Most rates for which the pivots are sought, O(n³); beyond, M_jj = 0 alone tells.
inline constexpr int most_pivots = 600;

/// Whether some joint's body, with what is welded to it, has no inertia along it to rounding: else
/// M is regular. Always true for a Lagrangian. O(bodies)
bool inertia_may_be_missing(const Tree& tree);

/// Massless joints by ascending rate. `q` (nq), `diagonal`: M_jj (nv), `mass`: M (nv × nv), empty
/// where too large. `known`: a rate known to be among them, −1: none.
std::vector<MasslessJoint> massless_joints(const Tree& tree, const double* q,
                                           const Eigen::VectorXd& diagonal,
                                           const Eigen::MatrixXd& mass, int known = -1);

/// "joint 'a' has no inertia", "joints 'a', 'b' have no inertia": at most six by name.
std::string without_inertia(const Tree& tree, const std::vector<MasslessJoint>& joints);

/// "joints 'a', 'b' have no inertia: …; expected masses, …". `direction`: rates (nv) at which no
/// mass moves, named where it takes several; empty: that of the first joint.
std::string in_words(const Tree& tree, const std::vector<MasslessJoint>& joints,
                     const Eigen::VectorXd& direction = {});

}  // namespace momenta
