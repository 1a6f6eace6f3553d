#pragma once
// Coordinates that users name: "O", the only one of joint O, or the name of its column, "J.q2".

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Places in q and u. @throws SceneError with all names for an unknown one or a part of a
/// quaternion. O(bodies)
std::pair<int, int> coordinate_named(const Mechanism& mechanism, const std::string& name);

/// The name of the coordinate with this rate, as coordinate_named() takes it; empty where the joint
/// has a quaternion. O(coordinates)
std::string coordinate_of_rate(const Mechanism& mechanism, int rate);

// A function Σ c_i q_i of the pose that is held while other coordinates move:
//
//   "O", "J.q2", "S.qx"   a coordinate, one of a free body or of a quaternion among them
//   "S.wx"                the turn about the child's axis x: with ψ₀ the half of it at the start,
//                         q_x cos ψ₀ − q_w sin ψ₀ = 0, in which the sign of the quaternion drops out
//
// The turn holds no rate: a child that turns back to its place comes back to its pose.

struct HeldCoordinate {
  std::vector<std::pair<int, double>> terms;  ///< places in q, and the c_i
  std::vector<int> rates;                     ///< places in u of its rates
  /// Σ c_i q_i
  double value(const Eigen::VectorXd& q) const;
  /// Derivative by the rates (nv) at the pose q.
  Eigen::RowVectorXd row(Evaluation<double>& e, const Eigen::VectorXd& q, Eigen::Index nv) const;
};

/// Function at the pose q (nq). @throws SceneError for an unknown name
HeldCoordinate held_coordinate(const Mechanism& mechanism, const std::string& name,
                               const Eigen::VectorXd& q);

/// Name to hold, to remove the freedom of this rate.
std::string name_to_hold(const Mechanism& mechanism, int rate);

/// The turn of a spherical joint's child about an axis of the child (unit), at the pose q; rates
/// from `rate` in u, quaternion from `place` in q.
HeldCoordinate held_turn(int place, int rate, const Eigen::Vector3d& axis,
                         const Eigen::VectorXd& q);

}  // namespace momenta
