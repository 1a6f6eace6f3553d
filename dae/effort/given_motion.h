#pragma once
// A motion that is given, row by row: of some coordinates their values, rates and accelerations at
// each time. It comes from
//
//   drives   f, ḟ, f̈ of their laws, exact,
//   a table  columns of coordinates, and those of rates and accelerations where there are any,
//   holding  where the start has it, at rest.
//
// What a table does not have is differentiated: f' and f" at a row of the polynomial through the
// seven rows nearest in order, in the middle where there are as many on both sides,
//
//   f'(tᵢ) = Σ w¹ⱼ f(tⱼ),  f"(tᵢ) = Σ w²ⱼ f(tⱼ),     errors O(h⁶) and O(h⁵) of equal steps h
//
// of q, or, where the table has u, of u. Weights: B. Fornberg, Math. Comp. 51 (1988) 699-706. Of a
// joint with a quaternion q = q̂/|q̂|, and u and u̇ are d/dt of H(q) u = q̇ along that curve.

#include <momenta/dae/measure/reference.h>
#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

/// Times, and what is given at each.
struct GivenMotion {
  /// What is given at one time.
  struct Row {
    double t = 0;          ///< [s]
    Eigen::VectorXd q;     ///< nq
    Eigen::VectorXd u;     ///< nv
    Eigen::VectorXd udot;  ///< nv
  };
  std::vector<bool> given;  ///< by rate: whether rows have it; entries of others mean nothing
  std::vector<Row> rows;    ///< by time
};

/// Where the motion comes from.
struct MotionSource {
  std::vector<DriveSpec> drives;     ///< of joints
  const Reference* table = nullptr;  ///< columns named as trajectory.csv has them; null: none
  std::vector<std::string> hold;     ///< coordinates that stay
  std::vector<double> times;         ///< [s]; with a table its own
  /// No rates and accelerations: they are zero. Without drives, table and `hold` all coordinates
  /// stay.
  bool poses_alone = false;
};

/// Of a mechanism whose joints have no drives of their own, from the pose `start` (nq). A
/// coordinate of the table is taken from there even if it has a drive.
/// @throws SceneError where a name or a unit is not known, a joint with a quaternion is given in
/// part, or rows are too few to be differentiated. O(rows × coordinates)
GivenMotion given_motion(const Mechanism& mechanism, const Eigen::VectorXd& start,
                         const MotionSource& source);

/// Refuses a drive whose effort is not found: of a loop, of a spherical or free joint.
/// @pre the scene has its joint. @throws SceneError
void expect_effort_of(const Scene& scene, const DriveSpec& drive);

/// Weights of f(x₀) … f(xₙ) in the first and second derivative at z of the polynomial through them:
/// (n + 1) × 2.
Eigen::MatrixXd derivative_weights(const std::vector<double>& x, double z);

/// The name of the column of the acceleration beside that of a rate: "O.udot [rad/s^2]".
Column acceleration_column(const Column& rate);

}  // namespace momenta
