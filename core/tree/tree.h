#pragma once
// The tree of a scene: bodies in depth-first order (a parent before its children, each subtree
// contiguous), joints with their places in q and u, everything in SI units. Independent of the
// algebra that will move it; immutable once built.

#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/scene.h>

#include <Eigen/Geometry>
#include <string>
#include <unordered_map>
#include <vector>

namespace momenta {

/// Bodies, joints and drives in the order of the sweeps; q, u and p by joint.
struct Tree {
  /// A body and the joint that carries it. Body frame: origin at the joint, on its axis; z along
  /// the axis of a revolute, prismatic or helical joint, else the axes of the scene's body.
  ///
  /// A joint of the scene may be a chain of `parts` such joints, one below the other, with
  /// consecutive indices. The last part carries the scene's body; those before it carry bodies
  /// without name, mass or extent, with scene axes that are the part's joint axes.
  struct Body {
    std::string name;    ///< of the scene's body; empty before the last part
    std::string joint;   ///< of the scene, which carries it
    int part = 0;        ///< this is part 0, 1, … of its joint
    int parts = 1;       ///< of so many
    int coordinate = 0;  ///< which coordinate of its joint a part moves; 0 with quaternions
    int parent = -1;     ///< −1: ground
    JointKind kind = JointKind::revolute;  ///< of this part
    int drive = -1;  ///< index into drives; then q and u of the joint are prescribed, nq = nv = 0
    int q = 0;       ///< place of its coordinates in q
    int nq = 0;      ///< how many
    int u = 0;       ///< place of its rates in u and p
    int nv = 0;      ///< how many
    Eigen::Isometry3d placement;  ///< body frame at joint position zero, in the parent's body frame
    Eigen::Isometry3d scene_axes;  ///< the scene's body frame in this body frame
    double mass = 0;               ///< [kg]
    Eigen::Vector3d com;           ///< in the body frame [m]
    Eigen::Matrix3d inertia;       ///< about the com, body frame [kg m²]
    double pitch = 0;              ///< of a helical joint [m/rad]
    double stiffness = 0;          ///< of a joint of one coordinate, as in JointSpec
    double rest = 0;               ///< likewise
    double damping = 0;            ///< likewise
    double torque = 0;             ///< constant generalised force on such a joint [N m or N]
    std::shared_ptr<const JointFormula> law;  ///< of a user joint
  };

  std::string name;               ///< of the scene
  std::vector<Body> bodies;       ///< a parent before its children, each subtree contiguous
  std::vector<MotionLaw> drives;  ///< of joints, in the order of the scene
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  int nq = 0;                                         ///< size of q
  int nv = 0;                                         ///< size of u and p
  Eigen::VectorXd q0;                                 ///< the scene's start (nq)
  Eigen::VectorXd u0;                                 ///< the scene's start (nv)

  std::unordered_map<std::string, int> body_places;   ///< of body()
  std::unordered_map<std::string, int> joint_places;  ///< of carried_by()

  /// Index of a body by its scene name; −1 for "ground".
  int body(const std::string& scene_name) const;
  /// Index of the scene's body carried by the joint of this name: of its last part; or −1.
  int carried_by(const std::string& joint_name) const;
  /// Index of the first part of the joint that body `k` belongs to: k where joints have one part.
  int first_part(int k) const { return k - bodies[static_cast<std::size_t>(k)].part; }
  /// True for the last part of a joint, which carries the scene's body.
  bool carries_scene_body(int k) const {
    const Body& b = bodies[static_cast<std::size_t>(k)];
    return b.part + 1 == b.parts;
  }
  /// "joint 'O'", and "coordinate 1 of joint 'O'" for a part of several. For messages.
  std::string joint_in_words(int k) const;
  /// Makes the quaternions of q (nq) unit ones.
  void normalise(Eigen::VectorXd& q) const {
    for (const Body& b : bodies)
      if (b.nq >= 4) q.segment<4>(b.q + b.nq - 4).normalize();
  }
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
