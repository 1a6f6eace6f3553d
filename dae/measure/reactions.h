#pragma once
// The wrenches that joints and loops transmit. Eqs. (20), (21), (28), with the applied wrenches
// T_K, which include −Jᵀλ of the loops:
//
//   F_K = M_K A_K + Ω_K × (M_K Ω_K) − T_K + Σ 𝒯ᶠ F_child
//
// F_K is the whole wrench of joint K on its child body: the reaction, and along the free directions
// of the joint the forces of its spring, damper, drive and generalised forces. The wrench of a loop
// on its child is −λ times the unit wrenches of its rows; its parent takes the opposite wrench on
// the same line of action.
//
// The planar kernel has forces in the plane and torques normal to it. Loads out of the plane are
// not determined there, and are left out.

#include <momenta/dae/mechanism.h>

#include <string>
#include <vector>

namespace momenta {

/// The wrench on the child of a joint or loop, in ground axes.
struct Transmitted {
  std::string name;        ///< of the joint or loop
  Eigen::Vector3d at;      ///< the joint's or loop's point of the child, ground axes [m]
  Eigen::Vector3d force;   ///< [N]
  Eigen::Vector3d torque;  ///< about `at` [N m]
  bool unique = true;      ///< false: redundant loop equations leave this wrench undetermined
};

/// The wrenches of all joints and loops.
struct Reactions {
  std::vector<Transmitted> joints;  ///< in the order of joint_places()
  std::vector<Transmitted> loops;   ///< in the order of the scene
};

/// Wrenches at (t, q, u), with accelerations `udot` (nv) and force multipliers `lambda` (m) [N, N
/// m]. Cost O(bodies + loops).
Reactions reactions(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                    const Eigen::VectorXd& lambda);

/// Marks as not unique the wrenches that change with multipliers without effect on the motion, the
/// columns of `idle` (m × n, measure/rank.h).
void mark_undetermined(Reactions& all, const Mechanism& mechanism, double t,
                       const Eigen::VectorXd& q, const Eigen::MatrixXd& idle);

}  // namespace momenta
