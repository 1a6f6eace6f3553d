#pragma once
// The tree of a scene: bodies in depth-first order (a parent before its children, each subtree
// contiguous), joints with their places in q and u, everything in SI units. Independent of the
// algebra that will move it; immutable once built.

#include <momenta/core/scene/scene.h>
#include <momenta/core/tree/drive.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace momenta {

struct Tree {
  /// A body and the joint that carries it. Body frame: origin at the joint, on its axis; z along
  /// the axis of a revolute or prismatic joint, else the axes of the scene's body.
  struct Body {
    std::string name, joint;
    int parent = -1;  ///< −1: ground
    JointKind kind = JointKind::revolute;
    int drive = -1;  ///< index into drives; then q and u of the joint are prescribed, nq = nv = 0
    int q = 0, nq = 0;            ///< place and number of coordinates in q
    int u = 0, nv = 0;            ///< place and number of rates in u and p
    Eigen::Isometry3d placement;  ///< body frame at joint position zero, in the parent's body frame
    Eigen::Isometry3d scene_axes;                 ///< the scene's body frame in this body frame
    double mass = 0;                              ///< [kg]
    Eigen::Vector3d com;                          ///< in the body frame [m]
    Eigen::Matrix3d inertia;                      ///< about the com, body frame [kg m²]
    double stiffness = 0, rest = 0, damping = 0;  ///< of a one-dof joint
    double torque = 0;                            ///< constant generalised force on a one-dof joint
  };

  std::string name;
  std::vector<Body> bodies;
  std::vector<MotionLaw> drives;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  int nq = 0;                                         ///< size of q
  int nv = 0;                                         ///< size of u and p
  Eigen::VectorXd q0, u0;                             ///< the scene's start values (q: nq, u: nv)

  /// Index of a body by its scene name; −1 for "ground".
  int body(const std::string& scene_name) const;
  /// Index of the body carried by the joint of this name, or −1.
  int carried_by(const std::string& joint_name) const;
  /// Every body frame in ground axes with all joints at zero (drives too).
  std::vector<Eigen::Isometry3d> zero_poses() const;
  /// A point given in the scene's axes of a body (−1: ground), in the body frame.
  Eigen::Vector3d point(int body, const Eigen::Vector3d& scene_point) const;
  /// A direction, likewise.
  Eigen::Vector3d direction(int body, const Eigen::Vector3d& scene_direction) const;
};

/// Builds the tree. @throws SceneError where validate() would. Cost O(bodies).
Tree build_tree(const Scene& scene);

}  // namespace momenta
