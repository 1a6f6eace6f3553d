#pragma once
// The tree of a scene: bodies in depth-first order (a parent before its children, each subtree
// contiguous), joints with their places in q and u, everything in SI units. Independent of the
// algebra; immutable.

#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/scene.h>

#include <Eigen/Geometry>
#include <string>
#include <unordered_map>
#include <vector>

namespace momenta {

/// Bodies, joints and drives in the order of the sweeps, with the layout of q, u and p.
struct Tree {
  /// A body and the joint that carries it. Body frame: origin on the joint's axis; z along the axis
  /// of a revolute, prismatic or helical joint, else the axes of the scene's body.
  ///
  /// A joint of the scene may become a chain of `parts` joints with consecutive indices. The last
  /// part carries the scene's body; those before carry bodies without name, mass or extent, whose
  /// scene axes are the joint axes of the part.
  struct Body {
    std::string name;    ///< the scene's body; empty for all but the last part
    std::string joint;   ///< the scene's joint that carries it
    int part = 0;        ///< place of this part in its joint: 0, 1, …
    int parts = 1;       ///< number of parts of that joint
    int coordinate = 0;  ///< coordinate of its joint that the part moves; 0 with quaternions
    int parent = -1;     ///< −1: ground
    JointKind kind = JointKind::revolute;  ///< kind of this part
    int drive = -1;  ///< index into drives; then q and u of the joint are prescribed, nq = nv = 0
    int q = 0;       ///< first of its coordinates in q
    int nq = 0;      ///< number of its coordinates
    int u = 0;       ///< first of its rates in u and p
    int nv = 0;      ///< number of its rates
    Eigen::Isometry3d placement;  ///< body frame at joint position zero, in the parent's body frame
    Eigen::Isometry3d scene_axes;  ///< the scene's body frame in this body frame
    double mass = 0;               ///< [kg]
    Eigen::Vector3d com;           ///< in the body frame [m]
    Eigen::Matrix3d inertia;       ///< about the com, body frame [kg m²]
    double pitch = 0;              ///< pitch of a helical joint [m/rad]
    double stiffness = 0;          ///< as in JointSpec, for joints of one coordinate
    double rest = 0;               ///< as in JointSpec
    double damping = 0;            ///< as in JointSpec
    double friction = 0;           ///< as in JointSpec
    double friction_rate = 0.1;    ///< as in JointSpec
    double least = 0;              ///< lower limit, where a stop begins
    double largest = 0;            ///< upper limit
    double stop_stiffness = 0;     ///< as in JointSpec; 0 without limits
    double stop_damping = 0;       ///< as in JointSpec
    double stop_width = 0.01;      ///< as in JointSpec
    double torque = 0;             ///< constant generalised force, one coordinate [N m or N]
    double rotor = 0;              ///< inertia on its rate; on all three of a ball [kg m² or kg]
    std::shared_ptr<const JointFormula> law;  ///< formula of a user joint

    /// Whether the last four of its coordinates are a unit quaternion w x y z. Then, and only then,
    /// nq ≠ nv and q̇ ≠ u.
    bool has_quaternion() const { return nq != nv; }
    /// Whether rate i is that of a length [m/s]: slides, shifts of free bodies, lengths of user
    /// joints; else [rad/s].
    bool is_length(int i) const;
  };

  std::string name;               ///< name of the scene
  std::vector<Body> bodies;       ///< a parent before its children, each subtree contiguous
  std::vector<MotionLaw> drives;  ///< laws of driven joints, in the order of the scene
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  int nq = 0;                                         ///< size of q
  int nv = 0;                                         ///< size of u and p
  Eigen::VectorXd q0;                                 ///< the scene's start (nq)
  Eigen::VectorXd u0;                                 ///< the scene's start (nv)

  std::unordered_map<std::string, int> body_places;   ///< body() by name
  std::unordered_map<std::string, int> joint_places;  ///< carried_by() by name

  /// Index of a body by its scene name; −1 for "ground".
  int body(const std::string& scene_name) const;
  /// Index of the body on the last part of the joint of this name; −1 for an unknown name.
  int carried_by(const std::string& joint_name) const;
  /// Index of the first part of the joint of body `k`.
  int first_part(int k) const { return k - bodies[static_cast<std::size_t>(k)].part; }
  /// Index of the part that moves coordinate 0, 1, … of a joint; the last part where none does.
  /// @pre the scene has the joint. O(parts)
  int part_of(const std::string& joint_name, int coordinate) const;
  /// Whether body `k` is the last part of a joint, which carries the scene's body.
  bool carries_scene_body(int k) const {
    const Body& b = bodies[static_cast<std::size_t>(k)];
    return b.part + 1 == b.parts;
  }
  /// "joint 'O'", or "coordinate 1 of joint 'O'" where the joint has several parts. For messages.
  std::string joint_in_words(int k) const;
  /// Normalises the quaternions in q (nq).
  void normalise(Eigen::VectorXd& q) const {
    for (const Body& b : bodies)
      if (b.has_quaternion()) q.segment<4>(b.q + b.nq - 4).normalize();
  }
  /// Every body frame in ground axes with all joints at zero, driven ones too.
  std::vector<Eigen::Isometry3d> zero_poses() const;
  /// A point in the body frame, from its coordinates in the axes of the scene's body (−1: ground).
  Eigen::Vector3d point(int body, const Eigen::Vector3d& scene_point) const;
  /// The same for a direction.
  Eigen::Vector3d direction(int body, const Eigen::Vector3d& scene_direction) const;
};

/// Builds the tree; for a Lagrangian it has no bodies, only layout and start of its coordinates.
/// @throws SceneError where validate() would. Cost O(bodies).
Tree build_tree(const Scene& scene);
/// The same for a scene known to be valid.
Tree build_valid_tree(const Scene& scene);

}  // namespace momenta
