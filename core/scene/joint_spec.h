#pragma once
// A joint of the tree of a scene: its frames, coordinates, forces along them, limits, and the
// bearing that its dry friction comes from (docs/theory/friction.md).

#include <momenta/core/scene/joint_kind.h>
#include <momenta/core/scene/location.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// The bearing of a revolute joint, a journal, or of a prismatic one, a slider. With N the force
/// across the axis and v the sliding speed, friction is N μ(v) against the motion,
///
///   μ(v) = μ_d tanh(4 x) + (μ_s − μ_d) x / (x²/4 + 3/4)²,   x = v / v_t
///
/// (Brown and McPhee, ASME J. Comput. Nonlinear Dyn. 11 (2016) 054502), largest near v_t.
/// Prismatic: v = u. Revolute: v = r u, and N μ(v) has the arm r.
struct BearingSpec {
  double static_friction = 0;         ///< μ_s, at least μ_d
  double dynamic_friction = 0;        ///< μ_d, at least 0
  double transition_velocity = 0.01;  ///< v_t [m/s], > 0
  double radius = 0;                  ///< revolute: r of the pin [m], > 0
  /// Distance along the axis [m] of two equal bearings on either side of the joint's point of the
  /// child, which carry the moment across the axis too. 0: one bearing, which carries none.
  double length = 0;
};

class JointFormula;  // core/scene/joint_formula.h

/// A joint of the tree; its child is a body, its parent a body or "ground". The joint frame in the
/// parent is at `origin_parent`, turned by `rotation`; that in the child is at `origin_child`,
/// parallel to the child's axes. At q = 0 (quaternion 1, 0, 0, 0) they coincide.
///
/// q, by kind:
///   - revolute, helical [rad], prismatic [m]; weld: none
///   - cylindrical: displacement along `axis` [m], then angle about it [rad]
///   - universal: angle about `axis`, which the joint frame holds, then about `axis2`, which the
///     child holds [rad]: child axes = R(axis, q1) R(axis2, q2) in the joint frame
///   - planar: displacements along `direction` and along axis × direction [m], then angle about
///     `axis` [rad]
///   - spherical: quaternion w x y z of the child axes in the joint frame
///   - free: position x y z [m] of the child point in the joint frame, then that quaternion
///   - user: as the formula in `law` says; the two frames need not coincide at q = 0. Not in files.
///     No springs, dampers, torques, drives or couplers on it
///
/// u, by kind:
///   - q̇ where no quaternion is in q; weld: none
///   - spherical: angular velocity [rad/s], child axes
///   - free: velocity of the child point [m/s], then angular velocity [rad/s], both in child axes
///
/// In a file, rotation is { rpy = [r, p, y] }, meaning Rz(y) Ry(p) Rx(r), or
/// { quaternion = [w, x, y, z] }, or { axis = .., angle = .. }; an axis is three numbers, which are
/// normalised, or "x", "-x", "y", ...
struct JointSpec {
  std::string name;                      ///< unique among joints and loops
  JointKind kind = JointKind::revolute;  ///< kind, with its coordinates
  std::string parent = "ground";         ///< a body, or "ground"
  std::string child;                     ///< a body, the child of this joint alone
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();       ///< in parent axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();        ///< in child axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< joint frame in parent axes
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();               ///< unit vector in the joint frame
  /// Universal: the second axis, a unit vector, not parallel to `axis`; zero means
  /// perpendicular_to(axis).
  Eigen::Vector3d axis2 = Eigen::Vector3d::Zero();
  /// Planar: q1 counts along the part of this perpendicular to `axis`; zero means
  /// perpendicular_to(axis). A unit vector in the joint frame, not parallel to `axis`.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double pitch = 0;  ///< helical: displacement along `axis` per angle about it [m/rad]
  std::shared_ptr<const JointFormula> law;  ///< user: a UserJoint, its pose as a formula of t and q
  std::vector<double> position;             ///< start value or first guess, size nq (empty: q = 0)
  std::vector<double> velocity;             ///< start value or first guess, size nv (empty: zero)
  double stiffness = 0;  ///< revolute, helical [N m/rad], prismatic [N/m]; else 0
  double rest = 0;       ///< revolute, helical [rad], prismatic [m]; else 0
  double damping = 0;    ///< revolute, helical [N m s/rad], prismatic [N s/m]; else 0
  /// Coulomb friction made smooth, −friction · u / √(u² + friction_rate²), on revolute, helical [N
  /// m] and prismatic [N] joints; else 0.
  double friction = 0;
  double friction_rate = 0.1;  ///< rate at 0.7 of the full friction [rad/s or m/s], > 0
  /// Friction by the joint's own reaction, on revolute and prismatic joints without drives.
  std::optional<BearingSpec> bearing;
  /// Inertia on each coordinate's rate, as of a motor's rotor behind its gear (gear ratio squared
  /// times its own): ½ I q̇² of kinetic energy beside that of the bodies. Revolute and helical
  /// joints [kg m²], prismatic ones [kg], each coordinate of cylindrical, universal and planar
  /// joints. Spherical joints: one number [kg m²], ½ I u·u, the same about every axis. Empty: none.
  /// No effect on the motion of a driven coordinate.
  std::vector<double> rotor_inertia;
  /// Least and largest q of a revolute, helical [rad] or prismatic [m] joint; for a spherical one 0
  /// and the largest angle of its turn from q = (1, 0, 0, 0), below π. Without stops no force:
  /// programs report when limits are passed.
  std::optional<std::array<double, 2>> limits;
  /// Stops at the limits: beyond one by x a spring stop_stiffness [N m/rad or N/m] and a damper
  /// stop_damping [N m s/rad or N s/m] push the joint back, both growing from 0 at the limit to
  /// their full value at x = stop_width [rad or m], with a continuous derivative: k x²/2w for x <
  /// w, then k (x − w/2). Needs limits.
  double stop_stiffness = 0;
  double stop_damping = 0;   ///< damping of the stops, at least 0
  double stop_width = 0.01;  ///< width w of the stops, > 0
  /// Rigid stops at the limits instead: the rate after an impact is −restitution times that before,
  /// 0 to 1. For revolute, helical and prismatic joints with limits; no number: no such stops.
  std::optional<double> restitution;
  Location at;  ///< where the file has it
};

/// Size of q of a joint, by its kind or its law.
int coordinates_of(const JointSpec& joint);
/// Size of u and p of a joint.
int rates_of(const JointSpec& joint);
/// Whether one of its coordinates has a rotor.
bool has_rotor(const JointSpec& joint);
/// Whether its limits have stops.
bool has_stops(const JointSpec& joint);

/// The default direction of a joint: of the coordinate axes the next one, in the order x y z x,
/// after the one nearest to `axis` (the first of equally near ones), made perpendicular to `axis`:
/// x for an axis along z, y for one along x, z for one along y.
Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis);

}  // namespace momenta
