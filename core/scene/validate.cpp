#include <momenta/core/scalar/all_finite.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/joint_formula.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/plane_curve.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/validate.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>

namespace momenta {
namespace {

using reading::Census;
using reading::check_limits;
using reading::in_quotes;
using reading::name_of;
using reading::require;

void check_bodies(const Scene& scene) {
  for (const BodySpec& body : scene.bodies) {
    const std::string who = "body " + in_quotes(body.name);
    require(std::isfinite(body.mass) && body.mass >= 0, scene, body.at, who,
            "mass must be finite and >= 0 [kg]");
    require(body.com.allFinite(), scene, body.at, who, "com must be finite [m]");
    const std::string fault = body.any_inertia ? reading::matrix_fault(body.inertia)
                                               : reading::inertia_fault(body.inertia);
    require(fault.empty(), scene, body.at, who, ("inertia " + fault).c_str());
    const auto& kinds = reading::shape_kinds;
    require(body.shape.kind.empty() ||
                std::find(kinds.begin(), kinds.end(), body.shape.kind) != kinds.end(),
            scene, body.at, who, "shape.kind must be rod, box, cylinder, sphere, point or empty");
    require(body.shape.size.allFinite() && body.shape.size.minCoeff() >= 0 &&
                body.shape.axis.allFinite(),
            scene, body.at, who, "shape must have finite sizes >= 0 [m] and a finite axis");
  }
}

/// Checks common to joints and loops: bodies, frames, axis.
template <class Edge>
void check_edge(const Scene& scene, const Census& census, const Edge& edge,
                const std::string& who) {
  census.require_body(edge.parent, true, edge.at, who, "parent");
  census.require_body(edge.child, false, edge.at, who, "child");
  require(edge.parent != edge.child, scene, edge.at, who,
          "parent and child are one body, expected two");
  require(edge.origin_parent.allFinite() && edge.origin_child.allFinite(), scene, edge.at, who,
          "origin must be finite [m]");
  require(std::abs(edge.rotation.norm() - 1) <= reading::norm_slack, scene, edge.at, who,
          "rotation must be a unit quaternion within 1e-6");
  require(!reading::has_axis(edge.kind) || std::abs(edge.axis.norm() - 1) <= reading::norm_slack,
          scene, edge.at, who, "axis must be a unit vector within 1e-6");
}

/// Checks a second axis or direction; zero: not given. `what` opens the sentences.
template <class Edge, class Kind>
void check_second_direction(const Scene& scene, const Edge& joint, const Eigen::Vector3d& second,
                            Kind owner, const std::string& what) {
  if (second == Eigen::Vector3d::Zero()) return;
  if (joint.kind != owner)
    throw SceneError(scene.where(joint.at) + what + " is for " + std::string(name_of(owner)) +
                     (std::is_same_v<Kind, LoopKind> ? " loops only" : " joints only") +
                     ", expected none here");
  if (!(std::abs(second.norm() - 1) <= reading::norm_slack))
    throw SceneError(
        scene.where(joint.at) + what +
        " is no direction, expected a unit vector within 1e-6, or zero for the default");
  if (joint.axis.cross(second).norm() < reading::parallel_slack)
    throw SceneError(scene.where(joint.at) + what +
                     " is parallel to axis, expected another direction");
}

/// Checks the law of a user joint; no other joint has one.
void check_law(const Scene& scene, const JointSpec& joint, const std::string& who) {
  if (joint.kind != JointKind::user)
    return require(!joint.law, scene, joint.at, who, "law is for user joints only");
  require(joint.law != nullptr, scene, joint.at, who, "law is missing, expected a UserJoint");
  const int n = joint.law->coordinates();
  require(n >= 1 && n <= 6, scene, joint.at, who,
          ("law has " + std::to_string(n) + " coordinates, expected 1 to 6").c_str());
}

/// Checks R Rᵀ = 1 and det R > 0 at the start, t = 0. @pre position is finite and of its size
void check_pose(const Scene& scene, const JointSpec& joint, const std::string& who) {
  constexpr double slack = 1e-10;
  double q[6]{};
  std::copy(joint.position.begin(), joint.position.end(), q);
  Eigen::Matrix3d r;
  Eigen::Vector3d step;
  joint.law->pose(0, q, r.data(), step.data());
  require(r.allFinite() && step.allFinite(), scene, joint.at, who,
          "law gives no finite pose at the start");
  const double fault = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require(fault <= slack && r.determinant() > 0, scene, joint.at, who,
          "law gives a matrix at the start that is no rotation within 1e-10");
}

/// Refuses angles of so many turns that rounding exceeds the gaps to which loops close.
void check_angles(const Scene& scene, const JointSpec& joint, const std::string& who) {
  constexpr double largest = 1e9;  // [rad], rounded to 1e-7
  const bool turns = joint.kind == JointKind::revolute || joint.kind == JointKind::helical ||
                     joint.kind == JointKind::universal;
  for (const double q : turns ? joint.position : std::vector<double>{})
    require(std::abs(q) <= largest, scene, joint.at, who,
            ("position is " + reading::digits(q) +
             " rad, where numbers are more than 1e-7 rad apart, expected at most 1e9 rad")
                .c_str());
}

void check_quaternion(const Scene& scene, const JointSpec& joint, const std::string& who) {
  if (joint.position.size() < 4) return;
  const Eigen::Map<const Eigen::Vector4d> quaternion(joint.position.data() + joint.position.size() -
                                                     4);
  require(std::abs(quaternion.norm() - 1) <= reading::norm_slack, scene, joint.at, who,
          "position must hold a unit quaternion within 1e-6");
}

void check_bearing(const Scene& scene, const JointSpec& joint, const std::string& who) {
  if (!joint.bearing) return;
  const BearingSpec& b = *joint.bearing;
  const bool turns = joint.kind == JointKind::revolute;
  require(turns || joint.kind == JointKind::prismatic, scene, joint.at, who,
          "bearing is for revolute and prismatic joints only");
  require(std::isfinite(b.dynamic_friction) && b.dynamic_friction >= 0 &&
              std::isfinite(b.static_friction) && b.static_friction >= b.dynamic_friction,
          scene, joint.at, who, "bearing must have finite dynamic >= 0 and static >= dynamic");
  require(std::isfinite(b.transition_velocity) && b.transition_velocity > 0, scene, joint.at, who,
          "bearing must have a finite transition > 0 [m/s]");
  require(std::isfinite(b.radius) && (turns ? b.radius > 0 : b.radius == 0), scene, joint.at, who,
          "bearing must have a finite radius > 0 [m] on a revolute joint, and none on a prismatic "
          "one");
  require(std::isfinite(b.length) && b.length >= 0, scene, joint.at, who,
          "bearing must have a finite length >= 0 [m]");
  for (const JointSpec& other : scene.joints)
    require(!other.restitution, scene, joint.at, who,
            ("has a bearing, whose friction is not determined at the impacts of joint " +
             in_quotes(other.name) + ", expected no restitution there")
                .c_str());
}

void check_joints(const Scene& scene, const Census& census) {
  for (const JointSpec& joint : scene.joints) {
    const std::string who = "joint " + in_quotes(joint.name);
    check_edge(scene, census, joint, who);
    check_law(scene, joint, who);
    require(joint.position.empty() ||
                joint.position.size() == static_cast<std::size_t>(coordinates_of(joint)),
            scene, joint.at, who, "position must be empty or of the size of its kind");
    require(joint.velocity.empty() ||
                joint.velocity.size() == static_cast<std::size_t>(rates_of(joint)),
            scene, joint.at, who, "velocity must be empty or of the size of its kind");
    require(all_finite(joint.position) && all_finite(joint.velocity), scene, joint.at, who,
            "position and velocity must be finite");
    check_angles(scene, joint, who);
    if (joint.kind == JointKind::spherical || joint.kind == JointKind::free)
      check_quaternion(scene, joint, who);
    if (joint.kind == JointKind::user) check_pose(scene, joint, who);
    require(
        std::isfinite(joint.stiffness) && std::isfinite(joint.rest) && std::isfinite(joint.damping),
        scene, joint.at, who, "stiffness, rest and damping must be finite");
    require(has_one_coordinate(joint.kind) ||
                (joint.stiffness == 0 && joint.rest == 0 && joint.damping == 0),
            scene, joint.at, who,
            "stiffness, rest and damping are for revolute, prismatic and helical joints only");
    require(std::isfinite(joint.friction) && joint.friction >= 0, scene, joint.at, who,
            "friction must be finite and >= 0 [N m or N]");
    require(std::isfinite(joint.friction_rate) && joint.friction_rate > 0, scene, joint.at, who,
            "friction_rate must be finite and > 0 [rad/s or m/s]");
    require(has_one_coordinate(joint.kind) || joint.friction == 0, scene, joint.at, who,
            "friction is for revolute, prismatic and helical joints only");
    check_bearing(scene, joint, who);
    require(has_one_coordinate(joint.kind) || joint.kind == JointKind::spherical || !joint.limits,
            scene, joint.at, who,
            "limits are for revolute, prismatic, helical and spherical joints only");
    check_limits(scene, joint, who);
    require(!joint.restitution ||
                (joint.limits && has_one_coordinate(joint.kind) && joint.stop_stiffness == 0 &&
                 joint.stop_damping == 0 && *joint.restitution >= 0 && *joint.restitution <= 1),
            scene, joint.at, who,
            "restitution must be 0 to 1, of a revolute, prismatic or helical joint with limits and "
            "without stop_stiffness and stop_damping");
    require(joint.kind != JointKind::spherical || !joint.limits ||
                ((*joint.limits)[0] == 0 && (*joint.limits)[1] < std::numbers::pi),
            scene, joint.at, who,
            "limits of a spherical joint are others, expected 0 and an angle below pi [rad]");
    require(joint.rotor_inertia.empty() || joint.rotor_inertia.size() == rotors_of(joint.kind),
            scene, joint.at, who,
            "rotor_inertia must be empty, of one number for each coordinate of a revolute, "
            "prismatic, helical, cylindrical, universal or planar joint, or of one number for a "
            "spherical joint");
    require(std::all_of(joint.rotor_inertia.begin(), joint.rotor_inertia.end(),
                        [](double x) { return std::isfinite(x) && x >= 0; }),
            scene, joint.at, who, "rotor_inertia must be finite and >= 0 [kg m² or kg]");
    require(std::isfinite(joint.pitch), scene, joint.at, who, "pitch must be finite [m/rad]");
    require(joint.kind == JointKind::helical || joint.pitch == 0, scene, joint.at, who,
            "pitch is for helical joints only");
    check_second_direction(scene, joint, joint.axis2, JointKind::universal, who + ": axis2");
    check_second_direction(scene, joint, joint.direction, JointKind::planar, who + ": direction");
  }
}

/// Checks curves of slots and cams, radius and offset of a rack; no other loop has any.
void check_curves(const Scene& scene, const LoopSpec& loop, const std::string& who) {
  const auto check = [&](const CurveSpec& curve, bool of_this_kind, const std::string& what) {
    require(of_this_kind || curve.kind.empty(), scene, loop.at, who,
            (what + " is for slots and cams only").c_str());
    if (curve.kind.empty()) return;
    const std::string fault = curve_fault(curve, loop.axis);
    require(fault.empty(), scene, loop.at, who, (what + ": " + fault).c_str());
  };
  const bool cam = loop.kind == LoopKind::cam, slot = loop.kind == LoopKind::slot;
  check(loop.curve, cam || slot, "curve");
  check(loop.child_curve, cam, "child_curve");
  if (slot && !loop.curve.kind.empty())
    require(loop.curve.kind == "circle" || loop.curve.kind == "spline", scene, loop.at, who,
            "curve of a slot must be a circle, a spline or none");
  if (cam) {
    for (const CurveSpec* curve : {&loop.curve, &loop.child_curve})
      require(!curve->kind.empty() && (curve->kind != "spline" || curve->closed), scene, loop.at,
              who, "a cam must have two outlines, splines closed");
    require(loop.curve.kind != "flat" || loop.child_curve.kind != "flat", scene, loop.at, who,
            "a cam must have an outline that is curved");
  }
  if (loop.kind == LoopKind::rack)
    require(std::isfinite(loop.radius) && loop.radius > 0 && std::isfinite(loop.offset), scene,
            loop.at, who, "radius must be finite and > 0 [m], and offset finite [rad]");
  if (loop.kind == LoopKind::rolling)
    require(std::isfinite(loop.radius) && loop.radius > 0 && loop.crown_radius >= 0 &&
                loop.crown_radius <= loop.radius &&
                std::abs(loop.normal.norm() - 1) <= reading::norm_slack,
            scene, loop.at, who,
            "radius must be finite and > 0 [m], crown_radius 0 to radius, normal a unit vector "
            "within 1e-6");
}

void check_equation(const Scene& scene, const LoopSpec& loop, const std::string& who) {
  std::string fault;
  try {
    fault = equation_fault(scene, loop.kind, FormulaReader(scene).read(loop.equation));
  } catch (const ExpressionError& e) {
    fault = e.what();
  }
  require(fault.empty(), scene, loop.at, who,
          ("equation, " + in_quotes(loop.equation) + ", " + fault).c_str());
}

void check_loops(const Scene& scene, const Census& census) {
  for (const LoopSpec& loop : scene.loops) {
    const std::string who = "loop " + in_quotes(loop.name);
    require(has_equation(loop) != loop.equation.empty(), scene, loop.at, who,
            "equation must be given for an equation or a velocity-equation, and for no other kind");
    if (has_equation(loop)) {
      check_equation(scene, loop, who);
      continue;
    }
    if (loop.kind == LoopKind::coupler) {
      reading::check_coupler(scene, census, loop);
      continue;
    }
    check_edge(scene, census, loop, who);
    require(std::isfinite(loop.length) &&
                (loop.kind != LoopKind::distance || loop.length > 0 ||
                 reading::drive_of(scene, &DriveSpec::loop, loop.name, 0) != nullptr),
            scene, loop.at, who, "length must be finite and > 0 [m]");
    check_second_direction(scene, loop, loop.axis2, LoopKind::universal, who + ": axis2");
    check_second_direction(scene, loop, loop.direction,
                           loop.kind == LoopKind::rack ? LoopKind::rack : LoopKind::planar,
                           who + ": direction");
    check_curves(scene, loop, who);
  }
}

void check_visuals(const Scene& scene, const Census& census) {
  for (const VisualSpec& visual : scene.visuals) {
    const std::string who = "visual of body " + in_quotes(visual.body);
    census.require_body(visual.body, true, visual.at, who, "body");
    const auto& kinds = reading::visual_kinds;
    require(std::find(kinds.begin(), kinds.end(), visual.kind) != kinds.end(), scene, visual.at,
            who, "kind must be box, sphere, capsule, cylinder, ellipsoid or mesh");
    const bool mesh = visual.kind == "mesh";
    require(visual.size.allFinite() && (mesh || visual.size.minCoeff() >= 0), scene, visual.at, who,
            "size must be finite and >= 0 [m]");
    require(mesh != visual.file.empty(), scene, visual.at, who,
            "file must be given for a mesh, and for no other kind");
    require(visual.position.allFinite(), scene, visual.at, who, "position must be finite [m]");
    require(std::abs(visual.rotation.norm() - 1) <= reading::norm_slack, scene, visual.at, who,
            "rotation must be a unit quaternion within 1e-6");
    require(!visual.colour || (visual.colour->minCoeff() >= 0 && visual.colour->maxCoeff() <= 1),
            scene, visual.at, who, "colour must be red, green, blue from 0 to 1");
  }
}

void check_rest(const Scene& scene, const Census& census) {
  for (const MarkerSpec& marker : scene.markers) {
    const std::string who = "marker " + in_quotes(marker.name);
    census.require_body(marker.body, true, marker.at, who, "body");
    require(marker.point.allFinite(), scene, marker.at, who, "point must be finite [m]");
  }
  std::set<std::string> held;
  for (const std::string& joint : scene.held) {
    census.require_joint(joint, scene.held_at, "[assembly] hold");
    require(held.insert(joint).second, scene, scene.held_at, "[assembly] hold",
            ("names joint " + in_quotes(joint) + " twice, expected once").c_str());
  }
  require(scene.gravity.allFinite(), scene, {}, "gravity", "must be finite [m/s²]");
}

void check_run(const Scene& scene) {
  const RunDefaults& run = scene.run;
  require(std::isfinite(run.end_time) && run.end_time > 0, scene, {}, "[run]",
          "end must be finite and > 0 [s]");
  require(!run.step || (std::isfinite(*run.step) && *run.step > 0), scene, {}, "[run]",
          "step must be finite and > 0 [s]");
  require(!run.leak || (std::isfinite(*run.leak) && *run.leak > 0), scene, {}, "[run]",
          "leak must be finite and > 0 [1/s]");
  require(run.samples > 0, scene, {}, "[run]", "samples must be > 0");
}

}  // namespace

void validate(const Scene& scene) {
  const Census census(scene);
  if (scene.lagrangian) {
    reading::check_lagrangian(scene);
    return check_run(scene);
  }
  check_bodies(scene);
  check_joints(scene, census);
  check_loops(scene, census);
  reading::check_drives(scene, census);
  reading::check_forces(scene, census);
  reading::check_functions(scene);
  check_visuals(scene, census);
  check_rest(scene, census);
  check_run(scene);
  reading::check_tree(scene);
  reading::check_formulas(scene);
}

}  // namespace momenta
