// <robot>: links become bodies, joints become joints, mimic becomes a coupler.

#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/format/xml/known_elements.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/validate.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <optional>

namespace momenta::reading {
namespace {

using Eigen::Vector3d;
using Turn = Eigen::AngleAxisd;

constexpr std::array<std::string_view, 7> urdf_joints{
    "revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"};
constexpr std::array joint_kind_of{JointKind::revolute, JointKind::revolute, JointKind::prismatic,
                                   JointKind::weld,     JointKind::free,     JointKind::planar,
                                   JointKind::spherical};

/// Tags of Drake that join links.
constexpr std::array<std::string_view, 4> drake_ties{
    "drake:joint", "drake:ball_constraint", "drake:linear_bushing_rpy", "drake:tendon_constraint"};

/// "link 'arm'" of a <link name="arm">.
Node owned(const Node& node, const char* title) {
  const std::string* name = node.element().find("name");
  return node.of(std::string(title) + " " + in_quotes(name ? *name : "without a name"));
}

BodySpec read_link(const Node& link, Remarks& remarks) {
  BodySpec body;
  body.name = link.text("name");
  body.at = link.at();
  for (const Node& part : link.children()) {
    if (part.name() == "inertial") continue;
    if (part.name() == "collision") remarks.left_out("collision shapes");
  }
  const auto inertial = link.child("inertial");
  if (!inertial) return body;
  const Origin origin = read_origin(*inertial);
  const Node mass = inertial->required("mass");
  const auto moments = inertial->child("inertia");
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  if (moments) {
    const auto entry = [&](const char* name) { return moments->number(name); };
    const auto product = [&](const char* name) { return moments->number(name, 0); };
    const Eigen::Matrix3d turn = origin.turn.toRotationMatrix();
    inertia = symmetric(entry("ixx"), entry("iyy"), entry("izz"), product("ixy"), product("ixz"),
                        product("iyz"));
    if (turn != Eigen::Matrix3d::Identity()) {
      const Eigen::Matrix3d turned = turn * inertia * turn.transpose();
      inertia = 0.5 * (turned + turned.transpose());
    }
  } else if (mass.number("value") > 0) {
    inertial->fail("has a mass and no <inertia>, expected both");
  }
  weigh(body, mass.number("value"), origin.xyz, inertia, mass, remarks);
  return body;
}

/// The joint of that name, with at most one coordinate.
const JointSpec& coordinate_of(const Node& mimic, const std::string& name, const Scene& scene) {
  const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&](const JointSpec& j) { return j.name == name; });
  if (joint == scene.joints.end()) {
    std::vector<std::string_view> names;
    for (const JointSpec& j : scene.joints) names.push_back(j.name);
    mimic.fail("joint", "is " + in_quotes(name) + ", expected the name of a joint" +
                            did_you_mean(name, names));
  }
  if (joint->kind != JointKind::weld && !has_one_coordinate(joint->kind))
    mimic.fail("ties joint " + in_quotes(name) +
               ", which has several degrees of freedom, expected a revolute, continuous or "
               "prismatic one");
  return *joint;
}

/// q − multiplier · q_other = offset; nothing for a fixed joint. A fixed leader has q = 0.
std::optional<LoopSpec> read_mimic(const Node& mimic, const std::string& joint, const Scene& scene,
                                   FreeNames& edges) {
  const std::string other = mimic.text("joint");
  if (other == joint) mimic.fail("joint", "is the joint itself, expected another one");
  const bool leads = coordinate_of(mimic, other, scene).kind != JointKind::weld;
  if (coordinate_of(mimic, joint, scene).kind == JointKind::weld) return std::nullopt;
  LoopSpec loop;
  loop.kind = LoopKind::coupler;
  loop.at = mimic.at();
  loop.name = edges.free(joint + " mimic");
  const double multiplier = mimic.number("multiplier", 1);
  loop.joints = {joint};
  loop.ratios = {1};
  if (multiplier != 0 && leads) {
    loop.joints.push_back(other);
    loop.ratios.push_back(-multiplier);
  }
  loop.offset = mimic.number("offset", 0);
  return loop;
}

/// `lower` and `upper` of a revolute or prismatic joint; an empty range is left out, since files
/// have 0, 0 where nothing is known.
void read_limits(const Node& limit, const std::string& type, JointSpec& joint, Remarks& remarks) {
  const double lower = limit.number("lower", 0), upper = limit.number("upper", 0);
  if (type != "revolute" && type != "prismatic") {
    if (lower < upper) remarks.left_out("limits of " + type + " joints, which URDF does not limit");
  } else if (lower < upper)
    joint.limits = {lower, upper};
  else
    remarks.left_out("joint limits without a range");
}

JointSpec read_joint(const Node& node, Remarks& remarks) {
  JointSpec joint;
  joint.at = node.at();
  joint.name = node.text("name");
  node.text("type");
  joint.kind = joint_kind_of[node.word("type", urdf_joints, 0)];
  joint.parent = node.required("parent").text("link");
  joint.child = node.required("child").text("link");
  const Origin origin = read_origin(node);
  joint.origin_parent = origin.xyz;
  joint.rotation = origin.turn;
  if (has_axis(joint.kind)) {
    const auto axis = node.child("axis");
    joint.axis = axis ? axis->direction("xyz", Vector3d::UnitX()) : Vector3d(Vector3d::UnitX());
  }
  if (const auto limit = node.child("limit"))
    read_limits(*limit, node.text("type"), joint, remarks);
  if (const auto dynamics = node.child("dynamics")) {
    const double damping = dynamics->number("damping", 0);
    if (has_one_coordinate(joint.kind))
      joint.damping = damping;
    else if (damping != 0)
      remarks.left_out("dampers of joints of several degrees of freedom");
    if (const double friction = dynamics->number("friction", 0); friction != 0) {
      if (friction < 0) dynamics->fail("friction", "is negative, expected a number >= 0");
      if (has_one_coordinate(joint.kind)) {
        joint.friction = friction;
        remarks.count("taken as smooth friction: friction of joints");
      } else {
        remarks.left_out("friction of joints of several degrees of freedom");
      }
    }
  }
  return joint;
}

/// Refuses unexpanded xacro: its elements, or an expression in an attribute.
void refuse_xacro(const Node& node) {
  const bool expression =
      std::any_of(node.element().attributes.begin(), node.element().attributes.end(),
                  [](const Attribute& attribute) {
                    return attribute.text.find("${") != std::string::npos ||
                           attribute.text.find("$(") != std::string::npos;
                  });
  if (expression || node.name().starts_with("xacro:"))
    node.fail("is for xacro, expected a URDF: expand the file by \"xacro FILE > robot.urdf\"");
  for (const Node& part : node.children()) refuse_xacro(part);
}

}  // namespace

Origin read_origin(const Node& node) {
  Origin origin;
  const auto given = node.child("origin");
  if (!given) return origin;
  origin.xyz = given->vector("xyz", origin.xyz);
  if (given->has("quat_xyzw")) {
    if (given->has("rpy")) given->fail("has rpy and quat_xyzw, expected one of them");
    const std::vector<double> x = given->numbers("quat_xyzw", 4);
    const Eigen::Quaterniond turn(x[3], x[0], x[1], x[2]);
    if (!(turn.norm() > 0)) given->fail("quat_xyzw", "is zero, expected a quaternion x y z w");
    origin.turn = turn.normalized();
    return origin;
  }
  const Vector3d rpy = given->vector("rpy", Vector3d::Zero());
  origin.turn = Turn(rpy[2], Vector3d::UnitZ()) * Turn(rpy[1], Vector3d::UnitY()) *
                Turn(rpy[0], Vector3d::UnitX());
  return origin;
}

Scene read_urdf(const Element& element, const std::string& file, const ReadOptions& options) {
  Element renamed = element;
  const bool shared = rename_ground(renamed, options.free_root);
  const Node robot(renamed, "", file);
  refuse_xacro(robot);
  refuse_misspelt(robot, urdf_elements());
  Scene scene;
  scene.file = file;
  scene.name = robot.text("name", "");
  scene.gravity = {0, 0, -9.81};
  Remarks remarks;
  FreeNames edges;
  std::vector<Node> links, mimics;
  if (shared) remarks.say("called 'ground 2', as ground is what does not move: link 'ground'");
  const auto materials = colours_of(robot, remarks);
  for (const Node& node : robot.children("link")) {
    links.push_back(owned(node, "link"));
    scene.bodies.push_back(read_link(links.back(), remarks));
    draw_link(links.back(), {scene.bodies.back().name, file, materials}, scene.visuals, remarks);
  }
  if (links.empty()) robot.fail("has no <link>, expected at least one");
  for (const Node& node : robot.children("joint")) {
    const Node joint = owned(node, "joint");
    scene.joints.push_back(read_joint(joint, remarks));
    edges.take(scene.joints.back().name);
    if (joint.child("mimic")) mimics.push_back(joint);
  }
  const bool welded = hang_root(scene, robot, links, options.free_root, edges);
  for (const Node& joint : mimics) {
    if (const auto loop = read_mimic(*joint.child("mimic"), joint.text("name"), scene, edges))
      scene.loops.push_back(*loop);
    else
      remarks.left_out("mimic of fixed joints");
  }
  std::vector<Node> transmissions, gazebo;
  for (const Node& node : robot.children()) {
    if (node.name() == "loop")
      read_loop_tag(owned(node, "loop"), scene, edges);
    else if (node.name() == "coupling")
      read_coupling_tag(owned(node, "coupling"), scene, edges);
    else if (node.name() == "transmission")
      transmissions.push_back(owned(node, "transmission"));
    else if (node.name() == "gazebo")
      gazebo.push_back(node);
    else if (std::find(drake_ties.begin(), drake_ties.end(), node.name()) != drake_ties.end())
      node.fail("ties links and is not read, expected <loop>, or loops in a YAML file");
  }
  tell_unread(robot, urdf_elements(), remarks);
  for (const Node& node : gazebo) read_gazebo_tag(node, scene, edges, remarks);
  read_beside(file, options, scene, edges, remarks);
  for (const Node& node : transmissions) read_transmission(node, scene, remarks);
  if (scene.bodies.empty()) robot.fail("has one link only, the ground, expected a body");
  validate(scene);
  if (welded) tell_of_fixed_root(scene, remarks);
  scene.remarks = remarks.sentences();
  return scene;
}

}  // namespace momenta::reading
