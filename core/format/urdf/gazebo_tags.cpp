// <gazebo>: tags of a URDF for Gazebo. These change the mechanism:
//
//   <joint>, a joint of SDF between two links of the tree, which closes a loop;
//   for a joint, by `reference`: springStiffness k and springReference r, a spring −k (q − r);
//   for a link: turnGravityOff, or gravity false, which cancels its weight.
//
// With P and C the poses of a <joint>'s parent and child at q = 0 and J that of its <pose> in the
// child, the loop has the point o = C o_J, P⁻¹ o in the parent and C⁻¹ o in the child, and the
// child's axes P⁻¹ C in the parent's. It is closed in the pose of the file. <xyz> is a direction in
// the model for versions of Gazebo that read a URDF as SDF 1.4, and in J for later ones.

#include <momenta/core/format/sdf/sdf_frames.h>
#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <set>

namespace momenta::reading {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 6> types{"revolute", "continuous", "prismatic",
                                                "fixed",    "ball",       "universal"};
constexpr std::array kind_of_type{LoopKind::revolute, LoopKind::revolute,  LoopKind::prismatic,
                                  LoopKind::weld,     LoopKind::spherical, LoopKind::universal};

template <class All>
auto named(All& all, const std::string& name) {
  return std::find_if(all.begin(), all.end(), [&](const auto& x) { return x.name == name; });
}

std::string link_named(const Node& end, const Scene& scene) {
  const std::string link = end.content();
  if (named(scene.bodies, link) != scene.bodies.end()) return link;
  if (link == "world" || link == "ground") return "ground";
  std::vector<std::string_view> names;
  for (const BodySpec& body : scene.bodies) names.push_back(body.name);
  end.fail("is " + in_quotes(link) + ", expected the name of a link" + did_you_mean(link, names));
}

/// Pose of a link at q = 0, in the root's frame.
Pose at_zero(const std::string& link, const Scene& scene) {
  Pose pose;
  for (std::string at = link; at != "ground";) {
    const JointSpec& joint = *std::find_if(scene.joints.begin(), scene.joints.end(),
                                           [&](const JointSpec& j) { return j.child == at; });
    pose = Pose{joint.origin_parent, joint.rotation} * pose;
    at = joint.parent;
  }
  return pose;
}

/// The direction in <axis> or <axis2>, in the root's frame; `own`: pose of the joint.
Vector3d read_axis(const Node& axis, const Pose& own) {
  const Node xyz = axis.required("xyz");
  const Vector3d of_model = xyz.content_direction(), of_joint = own.turn * of_model;
  const auto whole = axis.child("use_parent_model_frame");
  if (const std::string frame = xyz.text("expressed_in", ""); !frame.empty()) {
    if (frame == "__model__") return of_model;
    xyz.fail("expressed_in", "is " + in_quotes(frame) + ", expected __model__");
  }
  if (whole) return whole->content_flag() ? of_model : of_joint;
  if ((of_model - of_joint).norm() < parallel_slack) return of_joint;
  xyz.fail(
      "is another direction in the model than in the joint's frame, and versions of Gazebo differ "
      "in which they take; expected <use_parent_model_frame> in the <axis>");
}

/// Remarks on limits and dynamics, which loops do not have.
void tell_dynamics(const Node& axis, Remarks& remarks) {
  if (const auto limit = axis.child("limit");
      limit && (limit->child("lower") || limit->child("upper")))
    remarks.left_out("limits of joints that close loops");
  const auto dynamics = axis.child("dynamics");
  if (!dynamics) return;
  for (const char* name : {"damping", "friction", "spring_stiffness"})
    if (const auto value = dynamics->child(name); value && value->content_number() != 0)
      return remarks.left_out("dampers, springs and friction of joints that close loops");
}

void close_loop(const Node& node, Scene& scene, FreeNames& edges, Remarks& remarks) {
  LoopSpec loop;
  loop.at = node.at();
  node.text("type");
  loop.kind = kind_of_type[node.word("type", types, 0)];
  loop.name = edges.free(node.text("name"));
  const Node parent = node.required("parent"), child = node.required("child");
  loop.parent = link_named(parent, scene);
  loop.child = link_named(child, scene);
  if (loop.parent == loop.child)
    node.fail("joins link " + in_quotes(loop.parent) + " to itself, expected two links");
  if (const std::string in = relative_to(node, ""); !in.empty() && in != child.content())
    node.required("pose").fail("is relative to " + in_quotes(in) + ", expected the child link");
  const Pose own = at_zero(loop.child, scene) * read_pose(node);
  const bool two = loop.kind == LoopKind::universal;
  if (has_axis(loop.kind)) {
    loop.axis = read_axis(node.required("axis"), own);
    tell_dynamics(node.required("axis"), remarks);
  }
  if (two) {
    loop.axis2 = read_axis(node.required("axis2"), own);
    tell_dynamics(node.required("axis2"), remarks);
    if (loop.axis.cross(loop.axis2).norm() < parallel_slack)
      node.fail("has axes that are parallel, expected two directions");
  }
  if (loop.child == "ground") {  // the parent is the fixed side
    std::swap(loop.parent, loop.child);
    if (two) loop.axis.swap(loop.axis2);
  }
  const Pose one = at_zero(loop.parent, scene).inverse(),
             other = at_zero(loop.child, scene).inverse();
  loop.origin_parent = (one * own).origin;
  loop.origin_child = (other * own).origin;
  loop.rotation = one.turn * other.turn.conjugate();
  loop.axis = other.turn * loop.axis;
  loop.axis2 = other.turn * loop.axis2;
  scene.loops.push_back(loop);
}

/// Reads one tag; false: it is none of these.
bool read_part(const Node& part, const std::string& reference, Scene& scene, FreeNames& edges,
               Remarks& remarks) {
  if (part.name() == "joint" && part.has("type")) {
    const std::string* name = part.element().find("name");
    close_loop(part.of("joint " + in_quotes(name ? *name : "without a name")), scene, edges,
               remarks);
    return true;
  }
  if (part.name() == "link" || part.name() == "model" || part.name() == "include")
    part.fail("adds bodies to a URDF and is not read, expected its own <link>s");
  const auto joint = named(scene.joints, reference);
  if (part.name() == "springStiffness" && joint != scene.joints.end()) {
    const double stiffness = part.content_number();
    if (stiffness != 0 && !has_one_coordinate(joint->kind))
      part.fail("is of joint " + in_quotes(reference) + ", expected a revolute or prismatic one");
    joint->stiffness = stiffness;
    return true;
  }
  if (part.name() == "springReference" && joint != scene.joints.end()) return true;
  const bool off = part.name() == "turnGravityOff", on = part.name() == "gravity";
  const auto link = named(scene.bodies, reference);
  if ((!off && !on) || link == scene.bodies.end()) return false;
  if (part.content_flag() == off)
    take_back_weight(link->name, link->com, link->mass, part.at(), scene);
  return true;
}

}  // namespace

void read_gazebo_tag(const Node& tag, Scene& scene, FreeNames& edges, Remarks& remarks) {
  const std::string reference = tag.text("reference", "");
  // As in sdformat, an attribute `value` replaces the text.
  Element whole_tag = tag.element();
  for (Element& part : whole_tag.children)
    if (const std::string* value = part.find("value")) part.text = *value;
  const Node node(whole_tag, tag.owner(), tag.file());
  const std::vector<Node> parts = node.children();
  bool whole = !parts.empty();
  for (const Node& part : parts) whole &= read_part(part, reference, scene, edges, remarks);
  if (!whole) remarks.left_out("<gazebo> of <robot>");
  const auto joint = named(scene.joints, reference);
  const auto rest = node.child("springReference");
  if (rest && joint != scene.joints.end() && joint->stiffness != 0)
    joint->rest = rest->content_number();
}

}  // namespace momenta::reading
