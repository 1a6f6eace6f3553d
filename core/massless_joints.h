#pragma once
// Joints that no inertia holds: rates v ≠ 0 with M v = 0. M is positive semidefinite, so where a
// pivot of
//
//   M = Lᵀ D L,    tips first,
//
// is lost, what is left of its row is lost with it, and elimination goes on without it. Each lost
// pivot is a joint whose articulated inertia is zero: either the body on it and all that it carries
// have none along it, M_jj = 0, or the joints it carries move alone what has some. Found once a
// sweep has failed, for the sentence that names them all: a sweep stops at the first.

#include <momenta/core/tree/tree.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

struct MasslessJoint {
  int rate;         ///< place in u
  bool weightless;  ///< M_jj = 0; else other joints move without this one what has inertia
};

/// Rates up to which the pivots are sought, O(n³); of more, M_jj = 0 alone tells.
inline constexpr int most_pivots = 600;

/// Ascending. `diagonal`: M_jj (nv). `mass`: M (nv × nv), or empty where it is too large. `known`:
/// a place in u that is among them, −1: none.
std::vector<MasslessJoint> massless_joints(const Tree& tree, const Eigen::VectorXd& diagonal,
                                           const Eigen::MatrixXd& mass, int known = -1);

/// "joint 'a' has no inertia", "joints 'a', 'b' have no inertia": six of them by name.
std::string without_inertia(const Tree& tree, const std::vector<MasslessJoint>& joints);

/// "joints 'a', 'b' have no inertia: …; expected masses, …"
std::string in_words(const Tree& tree, const std::vector<MasslessJoint>& joints);

}  // namespace momenta
