#pragma once
// What a scene needs, and so what every evaluation of it does: decided once, printed by `momenta
// check`.

#include <momenta/core/tree/tree.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Which kernel moves a scene.
enum class Algebra {
  automatic,  ///< planar where the scene is
  planar,     ///< three components: the scene moves in a plane
  spatial     ///< six
};

/// What evaluations of a scene do and leave out.
struct Plan {
  bool planar = false;            ///< 3-component algebra
  std::string planar_reason;      ///< why not, when spatial
  bool gravity = false;           ///< weights on bodies
  bool drives = false;            ///< rheonomic: Ω_t, Φ_t
  bool quasi_velocities = false;  ///< spherical or free joints: quaternions, p not canonical
  bool third_sweep = false;       ///< springs, dampers or wrenches on bodies
  bool joint_forces = false;      ///< springs, dampers or torques of joints
  /// Set by whoever closes the tree: velocities come from (7), not from the sweeps.
  bool loops = false;
  Eigen::Matrix3d basis = Eigen::Matrix3d::Identity();  ///< of the plane

  /// "kernel: planar, plane normal to z", … one pair a decision.
  std::vector<std::pair<std::string, std::string>> lines() const;
};

/// @throws SceneError when the planar algebra is asked for and the scene is not planar.
Plan make_plan(const Tree& tree, const Scene& scene, Algebra algebra = Algebra::automatic);

}  // namespace momenta
