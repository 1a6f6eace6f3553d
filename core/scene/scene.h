#pragma once
// A scene: the mechanism as its author wrote it, before any analysis. Plain data, SI units, angles
// in rad. Readers (read_scene) fill it from files; programs may fill it by hand.

#include <momenta/core/scene/bearing_spec.h>
#include <momenta/core/scene/curve_spec.h>
#include <momenta/core/scene/joint_kind.h>
#include <momenta/core/scene/lagrangian.h>
#include <momenta/core/scene/location.h>
#include <momenta/core/scene/visual.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace momenta {

class JointFormula;  // core/scene/joint_formula.h

/// Bad input. what() is one sentence: "file:line:column: what was found, what was expected".
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A solid of uniform density. A body is drawn with it, and it gives `com` and `inertia` where
/// these are not written out; what is written out takes precedence, each for itself. A rod is
/// slender and reaches from the body origin along its axis, its centre of mass half way. The other
/// shapes are centred on the body origin, or on `com` where that is given. A point has no inertia.
struct Shape {
  std::string kind;  ///< rod box cylinder sphere point, or empty
  /// rod: length, 0, 0; box: x, y, z; cylinder: length, radius, 0; sphere: radius, 0, 0 [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< rod, cylinder: direction in body axes
};

/// A rigid body.
///
/// In a file, inertia is [xx, yy, zz, xy, xz, yz], or [xx, yy, zz], or one number: the moment about
/// z of a planar body, stored as that of a thin plate, diag(Izz/2, Izz/2, Izz). (No distribution of
/// mass has the inertia diag(0, 0, Izz): no principal moment exceeds the sum of the other two. Ixx
/// and Iyy have no effect on motion in the plane.) A body with a mass has a shape or an inertia; a
/// body with mass 0 is massless.
struct BodySpec {
  std::string name;                               ///< any but "ground"
  double mass = 0;                                ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< centre of mass in body axes [m]
  /// About the centre of mass, body axes [kg m²]; its principal moments a ≤ b ≤ c satisfy
  /// 0 ≤ a and c ≤ a + b.
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  /// The inertia is taken as it is, even if no rigid body can have it: some robot files contain
  /// such inertias.
  bool any_inertia = false;
  Shape shape;  ///< how it is drawn; gives com and inertia where they are not written
  Location at;  ///< where the file has it
};

/// A joint of the tree; its child is a body, its parent a body or "ground". It has two joint
/// frames. The one in the parent has its origin at `origin_parent` and is turned by `rotation`; the
/// one in the child has its origin at `origin_child` and is parallel to the child's axes. At q = 0
/// (quaternion 1, 0, 0, 0) the two coincide.
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
///   - user: what the formula in `law` takes; the two frames need not coincide at q = 0. A file has
///     no such kind. No springs, dampers, torques, drives or couplers on it
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
  JointKind kind = JointKind::revolute;  ///< which coordinates it has
  std::string parent = "ground";         ///< a body, or "ground"
  std::string child;                     ///< a body, the child of this joint alone
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();       ///< in parent axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();        ///< in child axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< joint frame in parent axes
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();               ///< unit vector in the joint frame
  /// Universal: the second axis, a unit vector, not parallel to `axis`; zero means
  /// perpendicular_to(axis).
  Eigen::Vector3d axis2 = Eigen::Vector3d::Zero();
  /// Planar: q1 counts along the part of this that is perpendicular to `axis`; zero means
  /// perpendicular_to(axis). A unit vector in the joint frame, not parallel to `axis`.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double pitch = 0;  ///< helical: displacement along `axis` per angle about it [m/rad]
  std::shared_ptr<const JointFormula> law;  ///< user: a UserJoint, its pose as a formula of t and q
  std::vector<double> position;             ///< start value or first guess, size nq (empty: q = 0)
  std::vector<double> velocity;             ///< start value or first guess, size nv (empty: zero)
  double stiffness = 0;  ///< revolute, helical [N m/rad], prismatic [N/m]; else 0
  double rest = 0;       ///< revolute, helical [rad], prismatic [m]; else 0
  double damping = 0;    ///< revolute, helical [N m s/rad], prismatic [N s/m]; else 0
  /// Coulomb friction made smooth, −friction · u / √(u² + friction_rate²): of revolute, helical
  /// joints [N m], prismatic ones [N]; else 0.
  double friction = 0;
  double friction_rate = 0.1;  ///< rate at which it has 0.7 of its force [rad/s or m/s], > 0
  /// Friction by the joint's own reaction: of revolute and prismatic joints that no drive moves.
  std::optional<BearingSpec> bearing;
  /// Inertia on each coordinate's rate, as of a motor's rotor behind its gear (gear ratio squared
  /// times its own): ½ I q̇² of kinetic energy beside that of the bodies. Of revolute and helical
  /// joints [kg m²], prismatic ones [kg], and of each coordinate of cylindrical, universal and
  /// planar joints. Of spherical joints one number [kg m²], ½ I u·u: the same about every axis.
  /// Empty: none. On a driven coordinate it has no effect on the motion.
  std::vector<double> rotor_inertia;
  /// Least and largest q of a revolute, helical [rad] or prismatic [m] joint; of a spherical one 0
  /// and the largest angle of its turn from q = (1, 0, 0, 0), below π. Without stops they exert no
  /// force: programs tell when they are passed.
  std::optional<std::array<double, 2>> limits;
  /// Stops at the limits: beyond one by x the joint is pushed back by a spring stop_stiffness
  /// [N m/rad or N/m] and a damper stop_damping [N m s/rad or N s/m], both of which grow from 0 at
  /// the limit to all of it at x = stop_width [rad or m], with a continuous derivative:
  /// k x²/2w for x < w, then k (x − w/2). Of joints with limits.
  double stop_stiffness = 0;
  double stop_damping = 0;   ///< of the stops, at least 0
  double stop_width = 0.01;  ///< of the stops, w > 0
  /// Rigid stops at the limits instead: the rate after an impact is −restitution times that before,
  /// 0 to 1. Of revolute, helical and prismatic joints with limits; no number: no such stops.
  std::optional<double> restitution;
  Location at;  ///< where the file has it
};

/// Size of q of a joint: by its kind, or by its law.
int coordinates_of(const JointSpec& joint);
/// Size of u and p of a joint.
int rates_of(const JointSpec& joint);
/// Whether a rotor turns with one of its coordinates.
bool has_rotor(const JointSpec& joint);
/// Whether its limits push back.
bool has_stops(const JointSpec& joint);

/// The default direction of a joint. Of the coordinate axes, find the one nearest to `axis` (the
/// first of equally near ones), take the next in the order x y z x, and make it perpendicular to
/// `axis`: x for an axis along z, y for one along x, z for one along y.
Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis);

/// The kinds of loops, with their number of equations; the equations: LoopSpec.
enum class LoopKind {
  point,              ///< 3 equations, 2 in a plane
  revolute,           ///< 5
  spherical,          ///< 3, as point
  weld,               ///< 6
  prismatic,          ///< 5
  distance,           ///< 1
  universal,          ///< 4
  cylindrical,        ///< 4
  planar,             ///< 3
  coupler,            ///< 1, between coordinates of joints
  slot,               ///< 2, in a plane 1
  cam,                ///< 1
  rack,               ///< 1
  equation,           ///< 1, between coordinates, positions of markers and the time
  velocity_equation,  ///< 1, between rates and velocities of markers; nonholonomic
  rolling             ///< 3: contact, and two of the slip, which are nonholonomic
};

/// A joint that closes a loop. It has the keys of a joint, but no coordinates and no forces along
/// them. Its child is a body, its parent another body or "ground".
///   - `point` and `spherical` are the same three equations
///   - `distance` keeps |origin_parent − origin_child| = length
///   - `universal` keeps the points together and `axis`, held by the parent, at its angle to
///     `axis2`, held by the child
///   - `planar` keeps the child's point in the plane across `axis`, and `axis` common
///   - `coupler` ties coordinates of joints, not bodies: Σ ratios[i] q_i + Σ powers[k] x^(k+2) =
///     offset, x the coordinate of the last joint
///   - `slot` keeps the child's point on a curve of the parent: without `curve` on the line along
///     `axis`, else on a circle or spline in the plane across `axis`
///   - `cam` keeps the outlines `curve` of the parent and `child_curve` of the child, both in the
///     plane across `axis`, in contact: no gap along their common normal. It pulls as well as
///     pushes. Both bodies move across `axis`
///   - `rack`: the circle of the child with `radius` about origin_child rolls on the parent's line
///     through origin_parent along `direction`, on its side axis × direction: the angle of the
///     child about `axis` is `offset` − displacement / radius. The distance from the line is not
///     held
///   - `equation`: the formula `equation` is zero, of joint coordinates, positions of markers and t
///     (core/scene/formula.h); it ties what its names stand for, and has no bodies of its own
///   - `velocity_equation`: the formula `equation` is zero, linear in rates of joint coordinates
///   and
///     velocities of markers, with coefficients of coordinates, positions of markers and t
///   - `rolling`: the wheel of the child rolls without slipping on the plane of the parent through
///     origin_parent, on the side to which `normal` points: a circle about origin_child across
///     `axis`, of radius `radius` − `crown_radius`, thickened by `crown_radius`. A crown radius of
///     0 makes the wheel a disc with a sharp edge, one of `radius` a sphere. It pulls as well as
///     pushes
struct LoopSpec {
  std::string name;                                              ///< unique among joints and loops
  LoopKind kind = LoopKind::point;                               ///< point, revolute, …
  std::string parent = "ground";                                 ///< a body, or "ground"
  std::string child;                                             ///< a body, not the parent
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();       ///< in parent axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();        ///< in child axes [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< loop frame in parent axes
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();               ///< unit vector in the loop frame
  /// Universal: as for a joint; zero means perpendicular_to(axis).
  Eigen::Vector3d axis2 = Eigen::Vector3d::Zero();
  /// Planar: as for a joint, used where drives prescribe coordinates; rack: its line; zero means
  /// perpendicular_to(axis).
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0;  ///< distance [m]; no effect where a drive prescribes it
  /// Coupler: joints whose rates are their q̇, driven or not; no coordinate occurs twice.
  std::vector<std::string> joints;
  std::vector<int> coordinates;  ///< counted as for a drive, one for each joint; empty: all 0
  std::vector<double> ratios;    ///< [1, rad/m or m/rad], not zero, one for each joint
  /// Of the second to fourth power of the last joint's coordinate, at most three; where one is not
  /// zero that joint's ratio may be.
  std::vector<double> powers;
  double offset = 0;        ///< [rad or m]; no effect where a drive prescribes it
  CurveSpec curve;          ///< slot: circle or spline, or none; cam: outline of the parent
  CurveSpec child_curve;    ///< cam: outline of the child
  double radius = 0;        ///< rack, rolling: the largest [m], > 0
  double crown_radius = 0;  ///< rolling [m], 0 to `radius`
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< rolling: unit vector in the loop frame
  std::string equation;  ///< equation, velocity equation: a formula, without corners
  Location at;           ///< where the file has it
};

/// Whether a coupler is not linear.
bool has_powers(const LoopSpec& loop);

/// Whether a loop ties its parent and its child, and not what coordinates or formulas name.
bool ties_bodies(const LoopSpec& loop);

/// Whether a loop is a formula: of positions, or of velocities.
bool has_equation(const LoopSpec& loop);

/// Whether a loop is a higher pair of curves: a slot that is not straight, a cam, a rack.
bool has_curves(const LoopSpec& loop);

/// How many coordinates of a loop drives can prescribe: the coordinates of a joint of the same
/// kind, the length of a distance, the offset of a coupler, the displacement in a straight slot.
constexpr int driven_coordinates_of(LoopKind kind) {
  switch (kind) {
    case LoopKind::revolute:
    case LoopKind::prismatic:
    case LoopKind::distance:
    case LoopKind::coupler:
    case LoopKind::slot:
      return 1;
    case LoopKind::universal:
    case LoopKind::cylindrical:
      return 2;
    case LoopKind::spherical:
    case LoopKind::planar:
      return 3;
    case LoopKind::point:
    case LoopKind::weld:
    case LoopKind::cam:
    case LoopKind::rack:
    case LoopKind::equation:
    case LoopKind::velocity_equation:
    case LoopKind::rolling:
      return 0;
  }
  return 0;
}

/// A function of one number by points, which formulas call by its name.
struct FunctionSpec {
  std::string name;  ///< letters, digits and _, a letter first; none of those formulas have
  std::string kind = "cubic";  ///< cubic monotone linear: between the points; straight outside
  std::vector<double> x;       ///< increasing, at least two
  std::vector<double> y;       ///< one for each x
  Location at;                 ///< where the file has it
};

/// A drive: one number of a joint or of a loop as a function of time.
///
/// A drive of a joint prescribes a coordinate, counted from 0 as in the joint's q. In cylindrical,
/// universal and planar joints any coordinate can be driven, each by its own drive. A driven
/// spherical joint has drives for all of roll, pitch and yaw, which are coordinates 0, 1, 2: child
/// axes = Rz(yaw) Ry(pitch) Rx(roll) in the joint frame. A driven free joint has drives for all of
/// x, y, z, roll, pitch, yaw; on a body without mass it is a moving base.
///
/// A drive of a loop prescribes a coordinate, counted as in a joint of the same kind
/// (driven_coordinates_of), which is then no longer free; or a component of `origin_parent`, which
/// then moves. The value that the loop itself gives for a driven number has no effect.
///
///   - polynomial: f = Σ cᵢ tⁱ, coefficients = [c0, c1, ...]
///   - harmonic: f = offset + amplitude sin(ω t + φ), with ω = frequency [rad/s], φ = phase [rad]
///   - step: `from` → `to` between start and start + duration, by the quintic 10x³ − 15x⁴ + 6x⁵
///   - table: natural cubic spline through (times, values); constant slope outside
///   - formula: `law`, of t
/// MotionLaw (core/scene/drive.h) evaluates these laws.
struct DriveSpec {
  std::string joint;   ///< or `loop`: one of them is empty
  std::string loop;    ///< or `joint`
  int coordinate = 0;  ///< which of that joint or loop, from 0
  std::string origin;  ///< loops: "x", "y" or "z" of origin_parent instead of a coordinate
  std::string kind;    ///< polynomial harmonic step table formula
  std::vector<double> coefficients;     ///< polynomial: [rad or m, by s to the power]
  double offset = 0;                    ///< harmonic [rad or m]
  double amplitude = 0;                 ///< harmonic [rad or m]
  double frequency = 0;                 ///< harmonic: ω [rad/s]
  double phase = 0;                     ///< harmonic: φ [rad]
  double from = 0;                      ///< step [rad or m]
  double to = 0;                        ///< step [rad or m]
  double start = 0;                     ///< step [s]
  double duration = 0;                  ///< step [s]
  std::vector<double> times;            ///< table: ascending [s]
  std::vector<double> values;           ///< table: one for each time [rad or m]
  std::string law;                      ///< formula, of t [rad or m]
  std::vector<FunctionSpec> functions;  ///< formula: those of the scene that it calls
  Location at;                          ///< where the file has it
};

/// A force on the mechanism; the name is optional.
///   - "spring-damper": between a point of `parent` and a point of `child`, k (l − rest) + c dl/dt
///     along the line
///   - "bushing": at the point x of `child`, D from the point of `parent` to x, u the velocity of x
///     and ω the angular velocity of the child relative to the parent, θ the rotation vector of the
///     child's axes from `rotation`, |θ| <= π: force −k D − c u at x and couple −k_r θ − c_r ω on
///     the child, their opposites on the parent
///   - "coordinate-spring": along l = Σ ratios[i] q_i, coordinates as of a coupler: generalised
///     forces −ratios[i] (k (l − rest) + c dl/dt)
///   - "torque": generalised force `value` on a revolute or helical [N m] or prismatic [N] joint
///   - "wrench": constant force at `point` of `body`, and constant torque: in ground axes
///     (`axes = "ground"`, the default) or in body axes (`axes = "body"`)
///   - "potential": −∂V/∂s along every signal s of the formula V in `law`
/// Formulas (core/scene/formula.h) may stand in place of constants: `law` of a spring-damper or a
/// coordinate spring for its tension, of a torque for its value, `force_law` and `torque_law` for
/// components of a wrench. What they do counts as work done from outside, a potential's not.
struct ForceSpec {
  std::string name;  ///< or empty
  std::string kind;  ///< spring-damper bushing coordinate-spring torque wrench potential
  std::string law;   ///< a formula, or empty [N, N m or J]
  std::string parent = "ground";  ///< spring-damper, bushing: a body, or "ground"
  std::string child;              ///< spring-damper, bushing: a body
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();  ///< of the parent, its axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();   ///< of the child, its axes [m]
  /// Bushing: child axes without couple, in parent axes.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  double stiffness = 0;  ///< k [N/m]; coordinate-spring: [N m/rad or N/m] for a ratio of 1
  double damping = 0;    ///< c [N s/m]; coordinate-spring: [N m s/rad or N s/m] for a ratio of 1
  double rest = 0;       ///< spring-damper [m], coordinate-spring [rad or m]: l without force
  /// Of both: no spring force from rest to rest + dead_band, corners rounded over a twentieth of it
  /// to each side.
  double dead_band = 0;
  /// Of both: least and largest l [m or rad], told when passed, and stops there, as of a JointSpec.
  std::optional<std::array<double, 2>> limits;
  double stop_stiffness = 0;        ///< of the stops
  double stop_damping = 0;          ///< of the stops
  double stop_width = 0.01;         ///< of the stops, > 0
  double rotational_stiffness = 0;  ///< bushing: k_r [N m/rad]
  double rotational_damping = 0;    ///< bushing: c_r [N m s/rad]
  std::vector<std::string> joints;  ///< coordinate-spring: whose rates are their q̇
  std::vector<int> coordinates;     ///< coordinate-spring: as of a coupler; empty: all 0
  std::vector<double> ratios;       ///< coordinate-spring: not zero, one for each joint
  std::string joint;                ///< torque
  double value = 0;                 ///< torque [N m or N]
  std::string body;                 ///< wrench
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< wrench, in body axes [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< wrench [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< wrench [N m]
  bool in_body_axes = false;                         ///< wrench; else ground axes
  std::array<std::string, 3> force_law;   ///< wrench: formulas in place of components, or empty
  std::array<std::string, 3> torque_law;  ///< wrench, likewise
  Location at;                            ///< where the file has it
};

/// Whether limits of its length push back.
bool has_stops(const ForceSpec& force);

/// A named point of a body, or of "ground", whose position and velocity are reported in ground
/// axes.
struct MarkerSpec {
  std::string name;                                 ///< heads its columns of trajectory.csv
  std::string body;                                 ///< or "ground"
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< in body axes [m]
  Location at;                                      ///< where the file has it
};

/// A moment of a run to be told: where a formula passes zero.
struct EventSpec {
  std::string name;  ///< or empty: "event 1", by its place among the events
  /// A number of the mechanism (core/scene/formula.h), or of a Lagrangian's names; no comparison.
  FormulaSpec when;
  std::string direction = "both";  ///< up: from below zero to above it; down; both
  bool stop = false;               ///< the run ends there
  Location at;                     ///< where the file has it
};
/// Its name, or "event 1" by its place.
std::string name_of(const EventSpec& event, std::size_t place);

/// A number with a name, of which the file made others; here its value.
struct ParameterSpec {
  std::string name;   ///< as formulas have it
  double value = 0;   ///< in the units of what is made of it
  bool used = false;  ///< whether a formula of the scene takes it
};

/// The defaults of a run, for options that the command line does not give; also for `momenta
/// drift`.
struct RunDefaults {
  double end_time = 10;        ///< [s]
  std::optional<double> step;  ///< fixed-step integrators [s]
  std::optional<double> leak;  ///< gauge leak κ [1/s]
  int samples = 1000;          ///< output intervals
  bool project = false;  ///< correct positions after each step: scenes that pass singular poses
};

/// A mechanism as its author wrote it. read_scene() returns it; OpenChain and Mechanism take it.
struct Scene {
  std::string file;                   ///< for messages; empty when built by hand
  std::vector<std::string> included;  ///< files that this one includes, for messages
  std::string name;                   ///< for titles and tables
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  std::vector<BodySpec> bodies;                       ///< without the ground
  std::vector<JointSpec> joints;                      ///< one for each body
  std::optional<LagrangianSpec> lagrangian;           ///< instead of bodies, joints and loops
  std::vector<LoopSpec> loops;                        ///< empty: an open chain
  std::vector<DriveSpec> drives;                      ///< prescribed motion
  std::vector<ForceSpec> forces;          ///< forces besides gravity and those of joints
  std::vector<FunctionSpec> functions;    ///< what formulas may call
  std::vector<MarkerSpec> markers;        ///< points to be reported
  std::vector<EventSpec> events;          ///< moments of runs to be told
  std::vector<VisualSpec> visuals;        ///< solids to be drawn; no effect on motion
  std::vector<std::string> held;          ///< [assembly] hold: joints whose q and u assembly keeps
  Location held_at;                       ///< where the file has that list
  RunDefaults run;                        ///< [run] end, step, leak, samples
  std::vector<ParameterSpec> parameters;  ///< [parameters]; for reports: numbers here are values
  /// What the reader of another format left out or changed: one sentence per kind.
  std::vector<std::string> remarks;

  /// The prefix of a message about a place in this scene: "file:line:column: ", without line and
  /// column for a thing that did not come from a file, and "scene: " where the scene did not come
  /// from one.
  std::string where(Location at) const;
};

/// The length of the scene [m], the unit in which gaps of loops are judged. For each body and for
/// the ground take the box, along its axes, around its centre of mass and its points of joints,
/// loops, springs, wrenches and markers. The length is the largest diagonal of these boxes, or the
/// largest `length` of a loop if that is more; 1 when all of these are zero.
double length_of(const Scene& scene);

}  // namespace momenta
