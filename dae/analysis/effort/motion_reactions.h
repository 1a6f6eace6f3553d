#pragma once
// The wrenches in joints and loops along a motion by one coordinate, named as in trajectory.csv.
// With τ the effort of that coordinate c (dae/analysis/effort/actuation.h),
//
//   Φ_qᵀλ = e_c τ − (M u̇ + bias − Q),
//
// the islands of loops give λ, and reactions.h the wrenches. The wrench through ground,
// transmits,
//
//   F = Σ F_j,     N = Σ (N_j + x_j × F_j)      about the origin, over joints and loops on ground,
//
// is the negative of the shaking force and the shaking moment.
// Source: Berkof, Lowen, A new method for completely force balancing simple linkages, J. Eng. Ind.
// 91 (1969).

#include <momenta/dae/analysis/effort/actuation.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/topology/assembly/contradiction.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

class MotionReactions {
 public:
  /// For each joint, each loop between bodies and "ground": sizes "O.force" and "O.torque",
  /// "O.force_x" … "O.torque_z" in ground axes [N, N m]. Empty for a Lagrangian.
  static std::vector<std::string> names(const Mechanism& mechanism);

  /// `rate` of the swept coordinate. The mechanism must outlive it.
  MotionReactions(const Mechanism& mechanism, int rate);
  /// Values in the order of names(); NaN where redundant loop equations leave a component open.
  /// Drives stand. Cost: O(bodies), also for each such equation, and a dense QR of each island of
  /// loops
  Eigen::VectorXd at(const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                     const Eigen::VectorXd& udot);

 private:
  Eigen::VectorXd transmitted(const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                              const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda);

  const Mechanism& mechanism_;
  ScaledLoops loops_;
  LoopIslands islands_;
  std::optional<Contradiction> contradiction_;  ///< the first pose's
  Actuation actuation_;
  std::unique_ptr<WrenchSweep> sweep_;
};

}  // namespace momenta
