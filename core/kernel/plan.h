#pragma once
// The plan of a scene: what every evaluation computes and leaves out. Decided once; `momenta check`
// prints it.

#include <momenta/core/kernel/tree/tree.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// The kernel that evaluates a scene.
enum class Algebra {
  automatic,  ///< planar where the scene is planar
  planar,     ///< three components
  spatial     ///< six components
};

/// The decisions of a plan.
struct Plan {
  bool planar = false;            ///< 3-component algebra
  std::string planar_reason;      ///< why not, when spatial
  bool gravity = false;           ///< weights on bodies
  bool drives = false;            ///< rheonomic: Ω_t, Φ_t
  bool quasi_velocities = false;  ///< spherical or free joints: quaternions, p not canonical
  bool third_sweep = false;       ///< springs, dampers or wrenches on bodies
  int rotors = 0;                 ///< rates with a rotor's inertia
  bool joint_forces = false;      ///< springs, dampers or torques of joints
  /// The scene has loops: velocities come from (7), not from the sweeps. Mechanism sets it;
  /// make_plan() does not.
  bool loops = false;
  Eigen::Matrix3d basis = Eigen::Matrix3d::Identity();  ///< axes of the plane

  /// "kernel: planar, plane normal to z", …: one pair per decision.
  std::vector<std::pair<std::string, std::string>> lines() const;
};

/// Makes the plan. @throws SceneError when the planar algebra is requested and the scene is not
/// planar.
Plan make_plan(const Tree& tree, const Scene& scene, Algebra algebra = Algebra::automatic);

}  // namespace momenta
