#include <momenta/core/scalar/all_finite.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/joint_formula.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/plane_curve.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/validate.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

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
using reading::Subject;

void check_bodies(const Scene& scene) {
  for (const BodySpec& body : scene.bodies) {
    const Subject who{scene, body.at, "body " + in_quotes(body.name)};
    who.require(std::isfinite(body.mass) && body.mass >= 0, "mass must be finite and >= 0 [kg]");
    who.require(body.com.allFinite(), "com must be finite [m]");
    const std::string fault = body.any_inertia ? reading::matrix_fault(body.inertia)
                                               : reading::inertia_fault(body.inertia);
    who.require(fault.empty(), ("inertia " + fault));
    const auto& kinds = reading::shape_kinds;
    who.require(body.shape.kind.empty() ||
                    std::find(kinds.begin(), kinds.end(), body.shape.kind) != kinds.end(),
                "shape.kind must be rod, box, cylinder, sphere, point or empty");
    who.require(body.shape.size.allFinite() && body.shape.size.minCoeff() >= 0 &&
                    body.shape.axis.allFinite(),
                "shape must have finite sizes >= 0 [m] and a finite axis");
  }
}

/// Checks common to joints and loops: bodies, frames, axis.
template <class Edge>
void check_edge(const Census& census, const Edge& edge, const Subject& who) {
  census.require_body(edge.parent, true, who, "parent");
  census.require_body(edge.child, false, who, "child");
  who.require(edge.parent != edge.child, "parent and child are one body, expected two");
  who.require(edge.origin_parent.allFinite() && edge.origin_child.allFinite(),
              "origin must be finite [m]");
  who.require(std::abs(edge.rotation.norm() - 1) <= reading::norm_slack,
              "rotation must be a unit quaternion within 1e-6");
  who.require(
      !reading::has_axis(edge.kind) || std::abs(edge.axis.norm() - 1) <= reading::norm_slack,
      "axis must be a unit vector within 1e-6");
}

/// Checks a second axis or direction, `key`; zero: not given.
template <class Edge, class Kind>
void check_second_direction(const Edge& joint, const Eigen::Vector3d& second, Kind owner,
                            const std::string& key, const Subject& who) {
  if (second == Eigen::Vector3d::Zero()) return;
  if (joint.kind != owner)
    who.fail(key + " is for " + std::string(name_of(owner)) +
             (std::is_same_v<Kind, LoopKind> ? " loops only" : " joints only") +
             ", expected none here");
  who.require(
      std::abs(second.norm() - 1) <= reading::norm_slack,
      key + " is no direction, expected a unit vector within 1e-6, or zero for the default");
  who.require(!(joint.axis.cross(second).norm() < reading::parallel_slack),
              key + " is parallel to axis, expected another direction");
}

/// Checks the law of a user joint; no other joint has one.
void check_law(const JointSpec& joint, const Subject& who) {
  if (joint.kind != JointKind::user) return who.require(!joint.law, "law is for user joints only");
  who.require(joint.law != nullptr, "law is missing, expected a UserJoint");
  const int n = joint.law->coordinates();
  who.require(n >= 1 && n <= 6, ("law has " + std::to_string(n) + " coordinates, expected 1 to 6"));
}

/// Checks R Rᵀ = 1 and det R > 0 at the start, t = 0. @pre position is finite and of its size
void check_pose(const JointSpec& joint, const Subject& who) {
  constexpr double slack = 1e-10;
  double q[6]{};
  std::copy(joint.position.begin(), joint.position.end(), q);
  Eigen::Matrix3d r;
  Eigen::Vector3d step;
  joint.law->pose(0, q, r.data(), step.data());
  who.require(r.allFinite() && step.allFinite(), "law gives no finite pose at the start");
  const double fault = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  who.require(fault <= slack && r.determinant() > 0,
              "law gives a matrix at the start that is no rotation within 1e-10");
}

/// Refuses angles of so many turns that rounding exceeds the gaps to which loops close.
void check_angles(const JointSpec& joint, const Subject& who) {
  constexpr double largest = 1e9;  // [rad], rounded to 1e-7
  const bool turns = joint.kind == JointKind::revolute || joint.kind == JointKind::helical ||
                     joint.kind == JointKind::universal;
  for (const double q : turns ? joint.position : std::vector<double>{})
    who.require(std::abs(q) <= largest,
                ("position is " + reading::digits(q) +
                 " rad, where numbers are more than 1e-7 rad apart, expected at most 1e9 rad"));
}

void check_quaternion(const JointSpec& joint, const Subject& who) {
  if (joint.position.size() < 4) return;
  const Eigen::Map<const Eigen::Vector4d> quaternion(joint.position.data() + joint.position.size() -
                                                     4);
  who.require(std::abs(quaternion.norm() - 1) <= reading::norm_slack,
              "position must hold a unit quaternion within 1e-6");
}

void check_bearing(const Scene& scene, const JointSpec& joint, const Subject& who) {
  if (!joint.bearing) return;
  const BearingSpec& b = *joint.bearing;
  const bool turns = joint.kind == JointKind::revolute;
  who.require(turns || joint.kind == JointKind::prismatic,
              "bearing is for revolute and prismatic joints only");
  who.require(std::isfinite(b.dynamic_friction) && b.dynamic_friction >= 0 &&
                  std::isfinite(b.static_friction) && b.static_friction >= b.dynamic_friction,
              "bearing must have finite dynamic >= 0 and static >= dynamic");
  who.require(std::isfinite(b.transition_velocity) && b.transition_velocity > 0,
              "bearing must have a finite transition > 0 [m/s]");
  who.require(
      std::isfinite(b.radius) && (turns ? b.radius > 0 : b.radius == 0),
      "bearing must have a finite radius > 0 [m] on a revolute joint, and none on a prismatic "
      "one");
  who.require(std::isfinite(b.length) && b.length >= 0,
              "bearing must have a finite length >= 0 [m]");
  for (const JointSpec& other : scene.joints)
    who.require(!other.restitution,
                ("has a bearing, whose friction is not determined at the impacts of joint " +
                 in_quotes(other.name) + ", expected no restitution there"));
}

void check_joints(const Scene& scene, const Census& census) {
  for (const JointSpec& joint : scene.joints) {
    const Subject who{scene, joint.at, "joint " + in_quotes(joint.name)};
    check_edge(census, joint, who);
    check_law(joint, who);
    who.require(joint.position.empty() ||
                    joint.position.size() == static_cast<std::size_t>(coordinates_of(joint)),
                "position must be empty or of the size of its kind");
    who.require(joint.velocity.empty() ||
                    joint.velocity.size() == static_cast<std::size_t>(rates_of(joint)),
                "velocity must be empty or of the size of its kind");
    who.require(all_finite(joint.position) && all_finite(joint.velocity),
                "position and velocity must be finite");
    check_angles(joint, who);
    if (joint.kind == JointKind::spherical || joint.kind == JointKind::free)
      check_quaternion(joint, who);
    if (joint.kind == JointKind::user) check_pose(joint, who);
    who.require(
        std::isfinite(joint.stiffness) && std::isfinite(joint.rest) && std::isfinite(joint.damping),
        "stiffness, rest and damping must be finite");
    who.require(has_one_coordinate(joint.kind) ||
                    (joint.stiffness == 0 && joint.rest == 0 && joint.damping == 0),
                "stiffness, rest and damping are for revolute, prismatic and helical joints only");
    who.require(std::isfinite(joint.friction) && joint.friction >= 0,
                "friction must be finite and >= 0 [N m or N]");
    who.require(std::isfinite(joint.friction_rate) && joint.friction_rate > 0,
                "friction_rate must be finite and > 0 [rad/s or m/s]");
    who.require(has_one_coordinate(joint.kind) || joint.friction == 0,
                "friction is for revolute, prismatic and helical joints only");
    check_bearing(scene, joint, who);
    who.require(
        has_one_coordinate(joint.kind) || joint.kind == JointKind::spherical || !joint.limits,
        "limits are for revolute, prismatic, helical and spherical joints only");
    check_limits(joint, who);
    who.require(
        !joint.restitution ||
            (joint.limits && has_one_coordinate(joint.kind) && joint.stop_stiffness == 0 &&
             joint.stop_damping == 0 && *joint.restitution >= 0 && *joint.restitution <= 1),
        "restitution must be 0 to 1, of a revolute, prismatic or helical joint with limits and "
        "without stop_stiffness and stop_damping");
    who.require(joint.kind != JointKind::spherical || !joint.limits ||
                    ((*joint.limits)[0] == 0 && (*joint.limits)[1] < std::numbers::pi),
                "limits of a spherical joint are others, expected 0 and an angle below pi [rad]");
    who.require(
        joint.rotor_inertia.empty() || joint.rotor_inertia.size() == rotors_of(joint.kind),
        "rotor_inertia must be empty, of one number for each coordinate of a revolute, "
        "prismatic, helical, cylindrical, universal or planar joint, or of one number for a "
        "spherical joint");
    who.require(std::all_of(joint.rotor_inertia.begin(), joint.rotor_inertia.end(),
                            [](double x) { return std::isfinite(x) && x >= 0; }),
                "rotor_inertia must be finite and >= 0 [kg m² or kg]");
    who.require(std::isfinite(joint.pitch), "pitch must be finite [m/rad]");
    who.require(joint.kind == JointKind::helical || joint.pitch == 0,
                "pitch is for helical joints only");
    check_second_direction(joint, joint.axis2, JointKind::universal, "axis2", who);
    check_second_direction(joint, joint.direction, JointKind::planar, "direction", who);
  }
}

/// Checks curves of slots and cams, radius and offset of a rack; no other loop has any.
void check_curves(const LoopSpec& loop, const Subject& who) {
  const auto check = [&](const CurveSpec& curve, bool of_this_kind, const std::string& what) {
    who.require(of_this_kind || curve.kind.empty(), (what + " is for slots and cams only"));
    if (curve.kind.empty()) return;
    const std::string fault = curve_fault(curve, loop.axis);
    who.require(fault.empty(), (what + ": " + fault));
  };
  const bool cam = loop.kind == LoopKind::cam, slot = loop.kind == LoopKind::slot;
  check(loop.curve, cam || slot, "curve");
  check(loop.child_curve, cam, "child_curve");
  if (slot && !loop.curve.kind.empty())
    who.require(loop.curve.kind == "circle" || loop.curve.kind == "spline",
                "curve of a slot must be a circle, a spline or none");
  if (cam) {
    for (const CurveSpec* curve : {&loop.curve, &loop.child_curve})
      who.require(!curve->kind.empty() && (curve->kind != "spline" || curve->closed),
                  "a cam must have two outlines, splines closed");
    who.require(loop.curve.kind != "flat" || loop.child_curve.kind != "flat",
                "a cam must have an outline that is curved");
  }
  if (loop.kind == LoopKind::rack)
    who.require(std::isfinite(loop.radius) && loop.radius > 0 && std::isfinite(loop.offset),
                "radius must be finite and > 0 [m], and offset finite [rad]");
  if (loop.kind == LoopKind::rolling)
    who.require(std::isfinite(loop.radius) && loop.radius > 0 && loop.crown_radius >= 0 &&
                    loop.crown_radius <= loop.radius &&
                    std::abs(loop.normal.norm() - 1) <= reading::norm_slack,
                "radius must be finite and > 0 [m], crown_radius 0 to radius, normal a unit vector "
                "within 1e-6");
}

void check_equation(const Scene& scene, const LoopSpec& loop, const Subject& who) {
  std::string fault;
  try {
    fault = equation_fault(scene, loop.kind, FormulaReader(scene).read(loop.equation));
  } catch (const ExpressionError& e) {
    fault = e.what();
  }
  who.require(fault.empty(), ("equation, " + in_quotes(loop.equation) + ", " + fault));
}

void check_loops(const Scene& scene, const Census& census) {
  for (const LoopSpec& loop : scene.loops) {
    const Subject who{scene, loop.at, "loop " + in_quotes(loop.name)};
    who.require(
        has_equation(loop) != loop.equation.empty(),
        "equation must be given for an equation or a velocity-equation, and for no other kind");
    if (has_equation(loop)) {
      check_equation(scene, loop, who);
      continue;
    }
    if (loop.kind == LoopKind::coupler) {
      reading::check_coupler(scene, census, loop);
      continue;
    }
    check_edge(census, loop, who);
    who.require(std::isfinite(loop.length) &&
                    (loop.kind != LoopKind::distance || loop.length > 0 ||
                     reading::drive_of(scene, &DriveSpec::loop, loop.name, 0) != nullptr),
                "length must be finite and > 0 [m]");
    check_second_direction(loop, loop.axis2, LoopKind::universal, "axis2", who);
    check_second_direction(loop, loop.direction,
                           loop.kind == LoopKind::rack ? LoopKind::rack : LoopKind::planar,
                           "direction", who);
    check_curves(loop, who);
  }
}

void check_visuals(const Scene& scene, const Census& census) {
  for (const VisualSpec& visual : scene.visuals) {
    const Subject who{scene, visual.at, "visual of body " + in_quotes(visual.body)};
    census.require_body(visual.body, true, who, "body");
    const auto& kinds = reading::visual_kinds;
    who.require(std::find(kinds.begin(), kinds.end(), visual.kind) != kinds.end(),
                "kind must be box, sphere, capsule, cylinder, ellipsoid or mesh");
    const bool mesh = visual.kind == "mesh";
    who.require(visual.size.allFinite() && (mesh || visual.size.minCoeff() >= 0),
                "size must be finite and >= 0 [m]");
    who.require(mesh != visual.file.empty(),
                "file must be given for a mesh, and for no other kind");
    who.require(visual.position.allFinite(), "position must be finite [m]");
    who.require(std::abs(visual.rotation.norm() - 1) <= reading::norm_slack,
                "rotation must be a unit quaternion within 1e-6");
    who.require(
        !visual.colour || (visual.colour->minCoeff() >= 0 && visual.colour->maxCoeff() <= 1),
        "colour must be red, green, blue from 0 to 1");
  }
}

void check_rest(const Scene& scene, const Census& census) {
  for (const MarkerSpec& marker : scene.markers) {
    const Subject who{scene, marker.at, "marker " + in_quotes(marker.name)};
    census.require_body(marker.body, true, who, "body");
    who.require(marker.point.allFinite(), "point must be finite [m]");
  }
  const Subject hold{scene, scene.held_at, "[assembly] hold"};
  std::set<std::string> held;
  for (const std::string& joint : scene.held) {
    census.require_joint(joint, hold);
    hold.require(held.insert(joint).second,
                 ("names joint " + in_quotes(joint) + " twice, expected once"));
  }
  Subject{scene, {}, "gravity"}.require(scene.gravity.allFinite(), "must be finite [m/s²]");
}

void check_run(const Scene& scene) {
  const RunDefaults& run = scene.run;
  const Subject who{scene, {}, "[run]"};
  who.require(std::isfinite(run.end_time) && run.end_time > 0, "end must be finite and > 0 [s]");
  who.require(!run.step || (std::isfinite(*run.step) && *run.step > 0),
              "step must be finite and > 0 [s]");
  who.require(!run.leak || (std::isfinite(*run.leak) && *run.leak > 0),
              "leak must be finite and > 0 [1/s]");
  who.require(run.samples > 0, "samples must be > 0");
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
