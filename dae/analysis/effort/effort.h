#pragma once
// Inverse dynamics: the efforts of actuators along a given motion, for trees and loops.
//
//   Scene scene = read_scene("four_bar.toml");
//   const Mechanism mechanism(undriven(scene));
//   EffortRequest request;
//   request.motion.drives = scene.drives;
//   request.motion.times = {0, 0.1, 0.2};
//   const EffortResult result = effort(mechanism, request);
//
// The motion: given_motion.h; its loops closed: closed_motion.h; the efforts: actuation.h.

#include <momenta/dae/analysis/effort/given_motion.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Request: efforts to compute, along a motion.
struct EffortRequest {
  MotionSource motion;  ///< poses_alone: efforts hold each pose at rest
  /// Rates by coordinate ("O", "J.q2") or own name ("J.wx"). Empty: driven ones; without drives
  /// all, if there are no loops.
  std::vector<std::string> actuated;
  /// wᵢ of Σ wᵢ τᵢ² where actuators work against each other, by name as in `actuated`; others: 1
  /// for torques, L² for forces.
  std::vector<std::pair<std::string, double>> weights;
  double within = 1e-6;  ///< tolerance of motion, in units of the scene, and of unheld forces
};

/// An actuator.
struct Actuator {
  std::string name;   ///< "O"
  int rate = 0;       ///< place in u
  Column effort;      ///< "O.effort [N m]"
  double weight = 1;  ///< wᵢ, in 1/(N m)² or 1/N²
  int helical = -1;   ///< place among joint_places() of a helical joint, else −1
};

/// The efforts at a time.
struct EffortRow {
  double t = 0;            ///< [s]
  Eigen::VectorXd q;       ///< nq
  Eigen::VectorXd u;       ///< nv
  Eigen::VectorXd udot;    ///< nv
  Eigen::VectorXd effort;  ///< by actuator [N m or N]
  Eigen::VectorXd power;   ///< effort × rate, by actuator [W]
  /// Axial force through a helical joint, on its child along its axis, by actuator [N]; NaN for
  /// other joints, and where loops leave it open. The thread's torque about the axis is effort −
  /// pitch × thrust.
  Eigen::VectorXd thrust;
};

/// Efforts along a motion.
struct EffortResult {
  std::string scene;                ///< its name
  std::vector<Column> coordinates;  ///< names of q
  std::vector<Column> rates;        ///< names of u
  std::vector<Actuator> actuators;  ///< as named
  std::vector<EffortRow> rows;      ///< by time
  bool poses_alone = false;         ///< all rows are at rest
  std::size_t given = 0;            ///< rates that the motion prescribes
  int redundant = 0;                ///< most actuators beyond need
  int unactuated = 0;               ///< most motions without actuator or effort
  double gap = 0;                   ///< largest deviation from given coordinates, in units
  double missing = 0;               ///< largest force without actuator, relative to its terms
  /// Whether the result has thrusts.
  bool has_thrust() const;
};

/// The scene without drives of joints, which assembly keeps at their place at time t [s]. @throws
/// SceneError for drives of loops and of spherical and free joints
Scene undriven(Scene scene, double t = 0);

/// @pre no joint of the mechanism has a drive
/// @throws SceneError where a name is unknown, the loops cannot follow the motion (loop, distance,
/// time), the motion leaves coordinates open (names), or actuators do not hold it (motion and
/// missing force)
/// Cost of a row: O(bodies) without loops; with loops also dense decompositions, island by island.
EffortResult effort(const Mechanism& mechanism, const EffortRequest& request);

}  // namespace momenta
