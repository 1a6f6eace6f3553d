#pragma once
// A force of a scene.

#include <momenta/core/scene/location.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

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
/// Formulas (core/scene/formula.h) may replace constants: `law` the tension of a spring-damper or
/// coordinate spring and the value of a torque, `force_law` and `torque_law` components of a
/// wrench. Their work counts as done from outside, a potential's not.
struct ForceSpec {
  std::string name;  ///< optional
  std::string kind;  ///< spring-damper bushing coordinate-spring torque wrench potential
  std::string law;   ///< a formula, or empty [N, N m or J]
  std::string parent = "ground";  ///< spring-damper, bushing: a body, or "ground"
  std::string child;              ///< spring-damper, bushing: a body
  Eigen::Vector3d origin_parent = Eigen::Vector3d::Zero();  ///< point of the parent, its axes [m]
  Eigen::Vector3d origin_child = Eigen::Vector3d::Zero();   ///< point of the child, its axes [m]
  /// Bushing: child axes without couple, in parent axes.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  double stiffness = 0;  ///< k [N/m]; coordinate-spring: [N m/rad or N/m] for a ratio of 1
  double damping = 0;    ///< c [N s/m]; coordinate-spring: [N m s/rad or N s/m] for a ratio of 1
  double rest = 0;       ///< spring-damper [m], coordinate-spring [rad or m]: l without force
  /// Spring-damper, coordinate-spring: no spring force from rest to rest + dead_band, corners
  /// rounded over a twentieth of it to each side.
  double dead_band = 0;
  /// The same: least and largest l [m or rad], reported when passed, with stops as in JointSpec.
  std::optional<std::array<double, 2>> limits;
  double stop_stiffness = 0;        ///< stops: stiffness
  double stop_damping = 0;          ///< stops: damping
  double stop_width = 0.01;         ///< stops: width, > 0
  double rotational_stiffness = 0;  ///< bushing: k_r [N m/rad]
  double rotational_damping = 0;    ///< bushing: c_r [N m s/rad]
  std::vector<std::string> joints;  ///< coordinate-spring: joints with u = q̇
  std::vector<int> coordinates;     ///< coordinate-spring: as of a coupler; empty: all 0
  std::vector<double> ratios;       ///< coordinate-spring: not zero, one for each joint
  std::string joint;                ///< torque: the joint
  double value = 0;                 ///< torque [N m or N]
  std::string body;                 ///< wrench: the body
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< wrench, in body axes [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< wrench [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< wrench [N m]
  bool in_body_axes = false;                         ///< wrench: in body, not ground axes
  std::array<std::string, 3> force_law;   ///< wrench: formulas in place of components, or empty
  std::array<std::string, 3> torque_law;  ///< wrench, likewise
  Location at;                            ///< where the file has it
};

/// Whether limits of the length have stops.
bool has_stops(const ForceSpec& force);

/// "spring 'pull' from 'a' to 'b'" for the word "spring", or "spring from 'a' to 'b'" of a force
/// without a name.
std::string with_ends(const std::string& word, const ForceSpec& force);

}  // namespace momenta
