#pragma once
// All values of a mechanism at one state: the results of each equation of the paper, energies,
// centroidal momentum, and the wrenches that joints and loops transmit.
//
//   given v     p = M v (34), σ = 0 (the gauge in which p has no loop impulses)
//   given p     without loops v by (45); with loops v and σ solve (7): M v + Φ_qᵀσ = p,
//               Φ_q v = −Φ_t. p then includes Φ_qᵀσ
//   both        ṗ by (35), with loops by (8) without a leak;
//               bias:       M u̇ + bias = 0 moves the tree without loops: bias is the joint force to
//                           add for u̇ = 0
//               free:       M u̇ = −bias, as if no loop were there
//               constrained: (3), M u̇ + Φ_qᵀλ = −bias, Φ_q u̇ = −(Φ̈ at u̇ = 0)
//
// Joints without inertia (unheld_joints.h) have no accelerations, or undetermined ones. Let N be
// the motions that no inertia, and in (3) no loop, holds. M u̇ = r has a solution only where Nᵀr =
// 0; then the accelerations of the joints that take part in N are not determined, the others are.
// What does not exist is NaN: all of u̇ and λ, or u̇ of those joints.
//
// τ is a further generalised force along the joints; it is one of the applied forces everywhere.
// Without loops everything except M is O(bodies), and no system of loops is built.

#include <momenta/core/open_chain/centroidal.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/run/measure/reactions.h>

namespace momenta {

struct GivenState {
  double t = 0;       ///< [s]
  Eigen::VectorXd q;  ///< nq, quaternions of unit length
  Eigen::VectorXd v;  ///< nv: rates; with `of_momenta` for missing entries of p, M v
  bool of_momenta = false;
  Eigen::VectorXd p;          ///< nv, entries with `p_given` count, the others are M v
  std::vector<bool> p_given;  ///< nv, when of_momenta
  Eigen::VectorXd tau;        ///< nv
  std::string residue;        ///< residue of the start (residue_in_words), or empty
};

struct StateValues {
  Eigen::VectorXd v, p, qdot, pdot, bias;
  Eigen::VectorXd free, constrained;  ///< u̇; constrained: with loops only
  Eigen::VectorXd phi, phidot, sigma, lambda;
  int faded = 0;  ///< rows that the solution of (7) found dependent or nearly so: σ, λ not unique
  double kinetic = 0, potential = 0, hamiltonian = 0;  ///< H = p·v − T + V
  Centroidal centroidal;
  Reactions reactions;
  std::vector<double> markers;  ///< per marker x y z and velocity
  /// One sentence on missing values: joints without inertia, and what that takes away.
  std::string not_there;

  bool dense = false;  ///< `mass`, `loops` are set: nv + m ≤ dense_state_limit
  Eigen::MatrixXd mass;
  LoopRank loops;  ///< rank of Φ_q
};

inline constexpr int dense_state_limit = 300;  ///< unknowns, nv + m

/// @throws SceneError where numbers overflow.
StateValues evaluate_state(const Mechanism& mechanism, const GivenState& given);

}  // namespace momenta
