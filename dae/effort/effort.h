#pragma once
// Inverse dynamics: the efforts of actuators along a motion that is given, for trees and loops.
//
//   Scene scene = read_scene("four_bar.toml");
//   const Mechanism mechanism(undriven(scene));
//   EffortRequest request;
//   request.motion.drives = scene.drives;
//   request.motion.times = {0, 0.1, 0.2};
//   const EffortResult result = effort(mechanism, request);
//
// The motion: given_motion.h; its loops closed: closed_motion.h; the efforts: actuation.h.

#include <momenta/dae/effort/given_motion.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Which efforts, along which motion.
struct EffortRequest {
  MotionSource motion;  ///< what is given; poses_alone: efforts that hold each pose at rest
  /// Actuated rates, by coordinate ("O", "J.q2") or rate ("J.wx"). Empty: those that have drives;
  /// without drives all, where there are no loops.
  std::vector<std::string> actuated;
  /// wᵢ of Σ wᵢ τᵢ², where actuators work against each other, by name as in `actuated`; those that
  /// are not named: 1 for torques, L² for forces.
  std::vector<std::pair<std::string, double>> weights;
  double within = 1e-6;  ///< of motion, in units of the scene, and of forces that nothing holds
};

/// An actuator.
struct Actuator {
  std::string name;   ///< "O"
  int rate = 0;       ///< place in u
  Column effort;      ///< "O.effort [N m]"
  double weight = 1;  ///< wᵢ, in 1/(N m)² or 1/N²
  int helical = -1;   ///< place among joint_places(): of a helical joint, else −1
};

/// The efforts at a time.
struct EffortRow {
  double t = 0;            ///< [s]
  Eigen::VectorXd q;       ///< nq
  Eigen::VectorXd u;       ///< nv
  Eigen::VectorXd udot;    ///< nv
  Eigen::VectorXd effort;  ///< by actuator [N m or N]
  Eigen::VectorXd power;   ///< effort × rate, by actuator [W]
  /// Axial force through a helical joint, on its child along its axis, by actuator [N]; not a
  /// number of other joints, and where loops leave it open. The torque about the axis that goes
  /// with it through the thread is effort − pitch × thrust.
  Eigen::VectorXd thrust;
};

/// Efforts along a motion.
struct EffortResult {
  std::string scene;                ///< its name
  std::vector<Column> coordinates;  ///< of q
  std::vector<Column> rates;        ///< of u
  std::vector<Actuator> actuators;  ///< as named
  std::vector<EffortRow> rows;      ///< by time
  bool poses_alone = false;         ///< at rest
  std::size_t given = 0;            ///< how many rates the motion prescribes
  int redundant = 0;                ///< the most actuators beyond what the motion needs, along it
  int unactuated = 0;  ///< the most motions that no actuator acts on; they need no effort
  double gap = 0;      ///< how far loops moved what was given, at the most, in units of the scene
  double missing = 0;  ///< the largest force that no actuator gives, over the size of its terms
  /// Whether thrusts are there.
  bool has_thrust() const;
};

/// The scene without drives of joints; they stand where their drives have them at time t [s], which
/// assembly keeps. @throws SceneError for drives of loops and of spherical and free joints
Scene undriven(Scene scene, double t = 0);

/// @pre no joint of the mechanism has a drive
/// @throws SceneError where a name is not known, the loops cannot follow the motion (the loop, by
/// how much and when), the motion leaves coordinates open (which), or actuators do not hold it
/// (which motion is not held, and what force is missing)
/// Cost of a row: O(bodies) without loops; with loops also dense decompositions of the rates that
/// loops tie together, island by island.
EffortResult effort(const Mechanism& mechanism, const EffortRequest& request);

}  // namespace momenta
