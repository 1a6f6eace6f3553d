#pragma once
// What joints and loops transmit, loops' forces included. Eqs. (20), (21), (28): with applied
// wrenches T_K, and −Jᵀλ of the loops among them,
//
//   F_K = M_K A_K + Ω_K × (M_K Ω_K) − T_K + Σ 𝒯ᶠ F_child
//
// F_K is all that passes through joint K on its child body: the reaction, and along the joint's
// freedoms what its spring, damper, drive and generalised forces do. A loop's wrench on its child
// is −λ times the unit wrenches of its rows; its parent takes the negative, same line of action.
//
// The planar kernel knows forces in the plane and torques normal to it; what a planar mechanism
// carries across its plane is not determined and left out.

#include <momenta/dae/mechanism.h>

#include <string>
#include <vector>

namespace momenta {

/// Wrench on the child of a joint or loop, ground axes.
struct Transmitted {
  std::string name;        ///< of the joint or loop
  Eigen::Vector3d at;      ///< the joint's or loop's point of the child, ground axes [m]
  Eigen::Vector3d force;   ///< [N]
  Eigen::Vector3d torque;  ///< about `at` [N m]
  bool unique = true;  ///< false: redundant loops share this load in a way that nothing here tells
};

/// What all joints and loops transmit.
struct Reactions {
  std::vector<Transmitted> joints;  ///< in the order of joint_places()
  std::vector<Transmitted> loops;   ///< in the order of the scene
};

/// At (t, q, u) with accelerations `udot` (nv) and loop multipliers `lambda` (m, force [N, N m]).
/// Cost O(bodies + loops).
Reactions reactions(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                    const Eigen::VectorXd& lambda);

/// Marks what changes with forces that move nothing (`idle`: m × n, measure/rank.h).
void mark_undetermined(Reactions& all, const Mechanism& mechanism, double t,
                       const Eigen::VectorXd& q, const Eigen::MatrixXd& idle);

}  // namespace momenta
