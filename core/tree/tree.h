#pragma once
// The tree of a scene: bodies in depth-first order (a parent before its children, each subtree
// contiguous), joints with their places in q and u, everything in SI units. It does not depend on
// the algebra; immutable once built.

#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/scene.h>

#include <Eigen/Geometry>
#include <string>
#include <unordered_map>
#include <vector>

namespace momenta {

/// Bodies, joints and drives in the order of the sweeps, with the layout of q, u and p.
struct Tree {
  /// A body and the joint that carries it. Body frame: its origin is at the joint, on the joint's
  /// axis; its z is along the axis of a revolute, prismatic or helical joint; for other joints it
  /// has the axes of the scene's body.
  ///
  /// A joint of the scene may become a chain of `parts` such joints, each the child of the one
  /// before, with consecutive indices. The last part carries the scene's body; the parts before it
  /// carry bodies without name, mass or extent, whose scene axes are the joint axes of the part.
  struct Body {
    std::string name;    ///< of the scene's body; empty for all but the last part
    std::string joint;   ///< of the scene: the joint that carries it
    int part = 0;        ///< this is part 0, 1, … of its joint
    int parts = 1;       ///< of how many parts
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
    double friction = 0;           ///< likewise
    double friction_rate = 0.1;    ///< likewise
    double least = 0;              ///< limit at which a stop begins
    double largest = 0;            ///< likewise
    double stop_stiffness = 0;     ///< as in JointSpec; 0 without limits
    double stop_damping = 0;       ///< likewise
    double stop_width = 0.01;      ///< likewise
    double torque = 0;             ///< constant generalised force on such a joint [N m or N]
    double rotor = 0;              ///< inertia on its rate, a ball's three [kg m² or kg]
    std::shared_ptr<const JointFormula> law;  ///< of a user joint

    /// Whether the last four of its coordinates are a unit quaternion w x y z. Then, and only then,
    /// nq ≠ nv and q̇ ≠ u.
    bool has_quaternion() const { return nq != nv; }
    /// Whether rate i is that of a length [m/s]: slides, shifts of free bodies, and what a user
    /// joint says; else [rad/s].
    bool is_length(int i) const;
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
  /// Index of the body that the joint of this name carries, by its last part; −1 for an unknown
  /// name.
  int carried_by(const std::string& joint_name) const;
  /// Index of the first part of the joint that body `k` belongs to; k itself where that joint has
  /// one part.
  int first_part(int k) const { return k - bodies[static_cast<std::size_t>(k)].part; }
  /// Index of the part that moves one coordinate of a joint, 0, 1, …; the last part where none
  /// does.
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

/// Builds the tree. That of a Lagrangian has no bodies, only the layout and the start of its
/// coordinates. @throws SceneError where validate() would. Cost O(bodies).
Tree build_tree(const Scene& scene);
/// The same of a scene that is known to be valid.
Tree build_valid_tree(const Scene& scene);

}  // namespace momenta
