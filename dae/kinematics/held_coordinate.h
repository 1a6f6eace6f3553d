#pragma once
// What of a pose is held while others move, a function Σ c_i q_i that keeps its value:
//
//   "O", "J.q2", "S.qx"   a coordinate, one of a free body or of a quaternion among them
//   "S.wx"                the turn about the child's axis x: with ψ₀ the half of it at the start,
//                         q_x cos ψ₀ − q_w sin ψ₀ = 0, in which the sign of the quaternion drops out
//
// The second is no rate that is held: what turns back to its place comes back to its pose.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

struct HeldCoordinate {
  std::vector<std::pair<int, double>> terms;  ///< places in q, and their c
  std::vector<int> rates;                     ///< places in u of the rates that change it
  /// Σ c_i q_i
  double value(const Eigen::VectorXd& q) const;
  /// Its change by the rates (nv) at the pose q.
  Eigen::RowVectorXd row(Evaluation<double>& e, const Eigen::VectorXd& q, Eigen::Index nv) const;
};

/// At the pose q (nq). @throws SceneError where no coordinate or turn is called so
HeldCoordinate held_coordinate(const Mechanism& mechanism, const std::string& name,
                               const Eigen::VectorXd& q);

/// The name by which holding it takes away the freedom of this rate.
std::string name_to_hold(const Mechanism& mechanism, int rate);

/// The turn of a spherical joint's child, whose rates start at `rate` in u and quaternion at
/// `place` in q, about an axis of the child (unit), at the pose q.
HeldCoordinate held_turn(int place, int rate, const Eigen::Vector3d& axis,
                         const Eigen::VectorXd& q);

}  // namespace momenta
