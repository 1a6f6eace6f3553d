#pragma once
// A given motion, row by row: values, rates and accelerations of some coordinates at each time. It
// comes from
//
//   drives   f, ḟ, f̈ of their laws, exact,
//   a table  columns of coordinates, and those of rates and accelerations where there are any,
//   holding  where the start has it, at rest.
//
// Missing columns of a table are differentiated: f' and f" at a row of the polynomial through the
// seven nearest rows, centred where possible,
//
//   f'(tᵢ) = Σ w¹ⱼ f(tⱼ),  f"(tᵢ) = Σ w²ⱼ f(tⱼ),     errors O(h⁶) and O(h⁵) of equal steps h
//
// from q, or from u if the table has it. Weights: B. Fornberg, Math. Comp. 51 (1988) 699-706. A
// joint with a quaternion has q = q̂/|q̂|, and u and u̇ are d/dt of H(q) u = q̇ along that curve.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/measure/reference.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

/// A motion given by rows of times and states.
struct GivenMotion {
  /// State given at one time.
  struct Row {
    double t = 0;          ///< [s]
    Eigen::VectorXd q;     ///< nq
    Eigen::VectorXd u;     ///< nv
    Eigen::VectorXd udot;  ///< nv
  };
  std::vector<bool> given;  ///< whether rows have a rate
  std::vector<Row> rows;    ///< by time
};

/// Sources of the motion.
struct MotionSource {
  std::vector<DriveSpec> drives;     ///< drives of joints
  const Reference* table = nullptr;  ///< columns named as trajectory.csv has them; null: none
  std::vector<std::string> hold;     ///< coordinates held at the start
  std::vector<double> times;         ///< [s]; a table has its own
  /// Rates and accelerations are zero. Without drives, table and `hold` all coordinates stay.
  bool poses_alone = false;
};

/// The motion of a mechanism whose joints have no drives of their own, from the pose `start` (nq).
/// The table's coordinates go before drives.
/// @throws SceneError where a name or a unit is unknown, a joint with a quaternion is given in
/// part, or rows are too few to differentiate. O(rows × coordinates)
GivenMotion given_motion(const Mechanism& mechanism, const Eigen::VectorXd& start,
                         const MotionSource& source);

/// Refuses drives of loops, of spherical and of free joints.
/// @pre the scene has its joint. @throws SceneError
void expect_effort_of(const Scene& scene, const DriveSpec& drive);

/// Weights of f(x₀) … f(xₙ) in the first and second derivative at z of their polynomial: (n + 1) ×
/// 2.
Eigen::MatrixXd derivative_weights(const std::vector<double>& x, double z);

/// "O.udot [rad/s^2]", beside the column of a rate.
Column acceleration_column(const Column& rate);

}  // namespace momenta
