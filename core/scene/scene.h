#pragma once
// A scene: the mechanism as its author wrote it, before any analysis. Plain data, SI units, angles in rad.
// The reader (read_scene) fills it from TOML; programs may fill it by hand.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace momenta {

/// Where a thing stands in its file; line 0 means it did not come from a file.
struct Location {
  int line = 0;
  int column = 0;
};

/// Bad input. what() is one sentence: "file:line:column: what was found, what was expected".
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a body is drawn; `rod`, `box`, `cylinder`, `sphere` and `point` also give com and inertia.
struct Shape {
  std::string kind;                                ///< rod box cylinder sphere point, or empty
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< rod: length, 0, 0; box: x, y, z; cylinder: length, radius, 0; sphere: radius [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX(); ///< rod, cylinder: direction in body axes
};

struct BodySpec {
  std::string name;
  double mass = 0;                                       ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();         ///< centre of mass in body axes [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();     ///< about the centre of mass, body axes [kg m²]
  Shape shape;
  Location at;
};

enum class JointKind { revolute, prismatic, spherical, free, weld };

/// A joint of the tree. The joint frame sits in the parent body at `origin_parent`, turned by `rotation`; in the child
/// body at `origin_child`, parallel to the child's axes. At q = 0 the two frames coincide.
/// q: revolute [rad], prismatic [m]; spherical: quaternion w x y z of the child axes in the joint frame;
/// free: position x y z [m] of the child point in the joint frame, then that quaternion; weld: none.
/// u: revolute [rad/s], prismatic [m/s]; spherical: angular velocity in child axes [rad/s];
/// free: velocity of the child point [m/s], then angular velocity [rad/s], both in child axes.
struct JointSpec {
  std::string name;
  JointKind kind = JointKind::revolute;
  std::string parent = "ground";
  std::string child;
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();       ///< in parent axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();        ///< in child axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< joint frame in parent axes
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();               ///< unit vector in the joint frame
  std::vector<double> position;                                  ///< start value or first guess, size nq (empty: zero)
  std::vector<double> velocity;                                  ///< start value or first guess, size nv (empty: zero)
  double stiffness = 0, rest = 0, damping = 0;                   ///< revolute, prismatic: [N m/rad], [rad], [N m s/rad] or [N/m], [m], [N s/m]
  Location at;
};

enum class LoopKind { point, revolute, spherical, weld, prismatic, distance };

/// A joint that closes a loop; the same keys as a joint. `point` and `spherical` are the same three equations.
/// `distance` keeps |origin_parent − origin_child| = length.
struct LoopSpec {
  std::string name;
  LoopKind kind = LoopKind::point;
  std::string parent = "ground";
  std::string child;
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double length = 0;  ///< distance [m]
  Location at;
};

/// A joint coordinate as a function of time. Applies to revolute and prismatic joints.
///   polynomial  f = Σ c_i tⁱ                         coefficients = [c0, c1, ...]
///   harmonic    f = offset + amplitude sin(ω t + φ)   offset, amplitude, frequency [rad/s], phase [rad]
///   step        from → to between start and start + duration, by the quintic 10x³ − 15x⁴ + 6x⁵
///   table       natural cubic spline through (times, values); constant slope outside
struct DriveSpec {
  std::string joint;
  std::string kind;
  std::vector<double> coefficients;
  double offset = 0, amplitude = 0, frequency = 0, phase = 0;
  double from = 0, to = 0, start = 0, duration = 0;
  std::vector<double> times, values;
  Location at;
};

/// kind "spring-damper": between a point of `parent` and a point of `child`: k (l − rest) + c dl/dt along the line.
/// kind "torque": generalised force `value` on a revolute [N m] or prismatic [N] joint.
/// kind "wrench": constant force at `point` of `body` and torque, in ground axes (`axes = "ground"`, default) or body axes ("body").
struct ForceSpec {
  std::string name;
  std::string kind;
  std::string parent = "ground", child;                          ///< spring-damper
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();       ///< spring-damper, in parent axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();        ///< spring-damper, in child axes [m]
  double stiffness = 0, damping = 0, rest = 0;                   ///< [N/m], [N s/m], [m]
  std::string joint;                                             ///< torque
  double value = 0;                                              ///< torque [N m or N]
  std::string body;                                              ///< wrench
  Eigen::Vector3d point = Eigen::Vector3d::Zero();               ///< wrench, in body axes [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();               ///< wrench [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();              ///< wrench [N m]
  bool in_body_axes = false;                                     ///< wrench
  Location at;
};

/// A named point of a body (or of "ground") whose position and velocity are reported, in ground axes.
struct MarkerSpec {
  std::string name;
  std::string body;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Location at;
};

/// What a run takes when the command line does not say otherwise; also the values `momenta drift` starts from.
struct RunDefaults {
  double end_time = 10;              ///< [s]
  std::optional<double> step;        ///< fixed-step integrators [s]
  std::optional<double> leak;        ///< gauge leak κ [1/s]
  int samples = 1000;                ///< output intervals
};

struct Scene {
  std::string file;  ///< for messages; empty when built by hand
  std::string name;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  std::vector<BodySpec> bodies;
  std::vector<JointSpec> joints;
  std::vector<LoopSpec> loops;
  std::vector<DriveSpec> drives;
  std::vector<ForceSpec> forces;
  std::vector<MarkerSpec> markers;
  std::vector<std::string> held;  ///< joints whose position and velocity assembly must keep: [assembly] hold = [...]
  RunDefaults run;                ///< [run] end, step, leak, samples

  /// The sentence prefix "file:line:column: " of a place in this scene.
  std::string where(Location at) const;
};

}  // namespace momenta
