// <joint>: two links, a pose, and axes.
//
// Gears: <joint type="gearbox"> has θ2 = −ratio θ1, θ1 the angle from the reference body to the
// parent about `axis`, θ2 that from the reference body to the child about `axis2`; these angles are
// coordinates of joints between the same links. A missing axis is that of its joint. <mimic> has q
// = multiplier (q_leader − reference) + offset.

#include <momenta/core/format/sdf/sdf_model.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta::reading {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 9> types{"revolute",  "continuous", "prismatic",
                                                "fixed",     "ball",       "universal",
                                                "revolute2", "screw",      "gearbox"};
constexpr std::array kind_of_type{JointKind::revolute,  JointKind::revolute,  JointKind::prismatic,
                                  JointKind::weld,      JointKind::spherical, JointKind::universal,
                                  JointKind::universal, JointKind::helical};

constexpr double same_axis = 1e-3;  // [rad] between a gear and its joint: files round angles
constexpr std::array<double, 2> locked{0, 0};
constexpr double no_bound = 1e16;  // [rad or m]

/// The direction in <axis> or <axis2>, in world axes.
Vector3d read_axis(const Node& axis, const std::string& scope, const std::string& joint,
                   SdfModel& model) {
  Vector3d along = Vector3d::UnitZ();
  std::string in = joint;
  const auto whole_model = axis.child("use_parent_model_frame");
  if (model.older_than(5) || (whole_model && whole_model->content_flag()))
    in = scope.empty() ? "world" : model.frames.full(scope, "__model__", axis);
  if (const auto xyz = axis.child("xyz")) {
    along = xyz->content_direction();
    if (const std::string frame = xyz->text("expressed_in", ""); !frame.empty())
      in = model.frames.full(scope, frame, *xyz);
  }
  return model.frames.world(in, axis).turn * along;
}

/// A bound of <limit>; nothing: none, written as an infinity or 1e16 on that side, `sign`.
std::optional<double> bound(const Node& limit, const char* name, int sign) {
  const auto node = limit.child(name);
  if (!node) return std::nullopt;
  const std::string text = node->content();
  const bool minus = text.starts_with('-'), signed_ = minus || text.starts_with('+');
  const std::string size = text.substr(signed_ ? 1 : 0);
  const bool infinite = size == "inf" || size == "INF" || size == "infinity";
  const double value = infinite ? (minus ? -no_bound : no_bound) : node->content_number();
  if (std::abs(value) < no_bound) return value;
  if (value * sign < 0)
    node->fail("is " + in_quotes(text) + ", expected a number" +
               (sign > 0 ? " above the lower limit" : " below the upper limit"));
  return std::nullopt;
}

/// Least and largest coordinate; an empty range is left out, unless it is the value 0.
void read_limits(const Node& limit, JointSpec& joint, Remarks& remarks) {
  if (limit.child("lower") || limit.child("upper")) {
    const auto lower = bound(limit, "lower", -1), upper = bound(limit, "upper", 1);
    if (!lower && !upper) return;
    const std::array<double, 2> limits{lower.value_or(-no_bound), upper.value_or(no_bound)};
    if (limits[0] < limits[1] || limits == locked)
      joint.limits = limits;
    else
      remarks.left_out("joint limits without a range");
  }
}

/// Reads limits, springs, dampers and friction of an axis.
void read_dynamics(const Node& axis, JointSpec& joint, Remarks& remarks) {
  if (const auto limit = axis.child("limit")) read_limits(*limit, joint, remarks);
  const auto dynamics = axis.child("dynamics");
  if (!dynamics) return;
  const auto number = [&](const char* name) {
    const auto node = dynamics->child(name);
    return node ? node->content_number() : 0;
  };
  joint.damping = number("damping");
  joint.stiffness = number("spring_stiffness");
  joint.rest = joint.stiffness == 0 ? 0 : number("spring_reference");
  joint.friction = number("friction");
  if (joint.friction < 0) dynamics->child("friction")->fail("is negative, expected a number >= 0");
}

/// Reads n² I of a motor's rotor, in Drake's tags.
void read_rotor(const Node& node, JointSpec& joint) {
  const auto inertia = node.child("drake:rotor_inertia"), ratio = node.child("drake:gear_ratio");
  if (!inertia) return;
  const double n = ratio ? ratio->content_number() : 1, own = inertia->content_number();
  if (own < 0) inertia->fail("is " + digits(own) + ", expected a number >= 0 [kg m² or kg]");
  if (!has_one_coordinate(joint.kind))
    inertia->fail(
        "is of a joint that has no rate of its own for a rotor, expected a revolute, "
        "prismatic or screw joint");
  joint.rotor_inertia = {n * n * own};
}

/// Displacement per angle [m/rad].
double read_pitch(const Node& node) {
  if (const auto turn = node.child("screw_thread_pitch"))
    return turn->content_number() / (2 * std::numbers::pi);
  if (const auto old = node.child("thread_pitch")) {
    if (old->content_number() == 0) old->fail("is 0, expected another number");
    return -1 / old->content_number();
  }
  node.fail("has no <screw_thread_pitch>, expected one [m/turn]");
}

void read_mimic(const Node& axis, int number, const std::string& scope, SdfJoint& joint,
                const SdfModel& model, std::vector<SdfCoupler>& couplers) {
  const auto mimic = axis.child("mimic");
  if (!mimic) return;
  const auto value = [&](const char* name, double otherwise) {
    const auto node = mimic->child(name);
    return node ? node->content_number() : otherwise;
  };
  constexpr std::array<std::string_view, 2> axes{"axis", "axis2"};
  const double multiplier = value("multiplier", 1);
  SdfCoupler coupler;
  coupler.node = *mimic;
  coupler.name = joint.spec.name + " mimic";
  coupler.terms.push_back({joint.scoped, number, 1});
  if (multiplier != 0)
    coupler.terms.push_back({model.frames.full(scope, mimic->text("joint"), *mimic),
                             static_cast<int>(mimic->word("axis", axes, 0)), -multiplier});
  coupler.offset = value("offset", 0) - multiplier * value("reference", 0);
  couplers.push_back(coupler);
}

/// Welds a joint with both limits 0, which older files have for fixed ones.
void weld(SdfJoint& joint, JointSpec& springs, Remarks& remarks) {
  joint.spec.kind = JointKind::weld;
  joint.spec.rotor_inertia.clear();
  springs = {};
  remarks.count("welded: joints whose limits are both 0");
}

/// Splits a universal joint with springs, dampers, friction or limits into two revolute ones and a
/// massless body, so that each axis has its own.
void split(SdfJoint joint, const JointSpec& first, const JointSpec& second, SdfModel& model) {
  BodySpec cross;
  cross.at = joint.spec.at;
  cross.name = model.bodies.free(joint.spec.name + " cross");
  model.poses[cross.name] = {joint.origin, Eigen::Quaterniond::Identity()};
  model.scene.bodies.push_back(cross);
  SdfJoint outer = joint;
  joint.spec.kind = outer.spec.kind = JointKind::revolute;
  joint.spec.damping = first.damping, outer.spec.damping = second.damping;
  joint.spec.stiffness = first.stiffness, outer.spec.stiffness = second.stiffness;
  joint.spec.rest = first.rest, outer.spec.rest = second.rest;
  joint.spec.friction = first.friction, outer.spec.friction = second.friction;
  joint.spec.limits = first.limits, outer.spec.limits = second.limits;
  joint.child = outer.parent = cross.name;
  outer.axis = joint.axis2;
  outer.spec.name = model.edges.free(joint.spec.name + " axis2");
  outer.scoped += " axis2";
  const auto sprung = [](const JointSpec& s) { return s.damping != 0 || s.stiffness != 0; };
  joint.carries = outer.carries = sprung(first) || sprung(second);
  model.joints.push_back(joint);
  model.joints.push_back(outer);
}

}  // namespace

std::string SdfModel::body(const std::string& scope, const std::string& frame,
                           const Node& asked) const {
  const std::string link = frames.link(frames.full(scope, frame, asked), asked);
  return link == "world" ? "ground" : body_of.at(link);
}

void read_sdf_joint(const Node& node, const std::string& scope, SdfModel& model,
                    std::vector<SdfCoupler>& couplers) {
  node.text("type");
  const std::size_t type = node.word("type", types, 0);
  if (type == kind_of_type.size()) {
    model.gears.emplace_back(scope, node);
    return;
  }
  SdfJoint joint;
  joint.node = node;
  joint.spec.at = node.at();
  joint.spec.kind = kind_of_type[type];
  joint.spec.name = model.edges.free(model.in_scene(scope + node.text("name")));
  joint.scoped = scope + node.text("name");
  const Node parent = node.required("parent"), child = node.required("child");
  joint.parent = model.body(scope, parent.content(), parent);
  joint.child = model.body(scope, child.content(), child);
  if (joint.parent == joint.child)
    node.fail("joins link " + in_quotes(joint.parent) + " to itself, expected two links");
  const auto still = [&](const std::string& body) {
    return body == "ground" || model.fixed.contains(body);
  };
  if (still(joint.parent) && still(joint.child))
    return model.remarks.left_out("joints between links that do not move");
  const std::string frame =
      model.frames.has(joint.scoped + " joint") ? joint.scoped + " joint" : joint.scoped;
  joint.origin = model.frames.world(frame, node).origin;
  if (joint.spec.kind == JointKind::helical) joint.spec.pitch = read_pitch(node);
  read_rotor(node, joint.spec);

  std::array<JointSpec, 2> springs;
  const bool two = joint.spec.kind == JointKind::universal;
  constexpr std::array<const char*, 2> names{"axis", "axis2"};
  for (int i = 0; has_axis(joint.spec.kind) && i < (two ? 2 : 1); ++i) {
    const Node axis = node.required(names[static_cast<std::size_t>(i)]);
    (i == 0 ? joint.axis : joint.axis2) = read_axis(axis, scope, frame, model);
    read_dynamics(axis, springs[static_cast<std::size_t>(i)], model.remarks);
    read_mimic(axis, i, scope, joint, model, couplers);
  }
  if (two && joint.axis.cross(joint.axis2).norm() < parallel_slack)
    node.fail("has axes that are parallel, expected two directions");
  if (node.text("type") == "continuous" && springs[0].limits) {
    springs[0].limits.reset();
    model.remarks.left_out("limits of continuous joints, which SDF does not limit");
  }
  if (const auto axis = node.child("axis"); axis && joint.spec.kind == JointKind::spherical) {
    JointSpec given;
    read_dynamics(*axis, given, model.remarks);
    if (given.damping != 0 || given.stiffness != 0)
      model.remarks.left_out("springs and dampers of joints of several degrees of freedom");
    if (given.friction != 0)
      model.remarks.left_out("friction of joints of several degrees of freedom");
  }
  for (JointSpec& s : springs) {
    if (s.limits != locked) continue;
    s.limits.reset();
    if (two || node.required("axis").child("mimic"))
      model.remarks.left_out("joint limits without a range");
    else
      weld(joint, s, model.remarks);
  }
  const auto sprung = [](const JointSpec& s) { return s.damping != 0 || s.stiffness != 0; };
  const auto own = [&](const JointSpec& s) { return sprung(s) || s.limits || s.friction != 0; };
  if (two && (own(springs[0]) || own(springs[1])))
    return split(joint, springs[0], springs[1], model);
  if (!two) {
    joint.spec.limits = springs[0].limits;
    joint.spec.friction = springs[0].friction;
  }
  joint.spec.damping = springs[0].damping;
  joint.spec.stiffness = springs[0].stiffness;
  joint.spec.rest = springs[0].rest;
  joint.carries =
      joint.spec.kind == JointKind::helical || sprung(springs[0]) || has_rotor(joint.spec);
  model.joints.push_back(joint);
}

SdfCoupler read_sdf_gearbox(const Node& node, const std::string& scope, SdfModel& model) {
  SdfCoupler coupler;
  coupler.node = node;
  coupler.name = model.edges.free(model.in_scene(scope + node.text("name")));
  const Node reference = node.required("gearbox_reference_body"),
             ratio = node.required("gearbox_ratio");
  if (ratio.content_number() == 0) ratio.fail("is 0, expected another number");
  const std::string body = model.body(scope, reference.content(), reference);
  const auto term = [&](const char* link, const char* axis, double factor) {
    const Node at = node.required(link);
    const std::string other = model.body(scope, at.content(), at);
    const std::string frame = scope + node.text("name");
    const auto given = node.child(axis);
    for (const SdfJoint& joint : model.joints) {
      const bool ahead = joint.parent == body && joint.child == other;
      const bool back = joint.parent == other && joint.child == body;
      if ((!ahead && !back) || joint.spec.kind != JointKind::revolute) continue;
      const Vector3d along = given ? read_axis(*given, scope, frame, model) : joint.axis;
      if (joint.axis.cross(along).norm() > same_axis) continue;
      const double sign = (joint.axis.dot(along) > 0) == ahead ? 1 : -1;
      coupler.terms.push_back({joint.scoped, 0, sign * factor});
      return;
    }
    at.fail("has no revolute joint about the same axis with the reference body " + in_quotes(body) +
            ", expected one whose angle the gear takes");
  };
  term("parent", "axis", ratio.content_number());
  term("child", "axis2", 1);
  return coupler;
}

}  // namespace momenta::reading
