#include <momenta/core/scene/formula.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/topology/cut/interchange.h>
#include <momenta/dae/topology/cut/relative_motion.h>

#include <algorithm>

namespace momenta {

std::optional<JointKind> as_joint(LoopKind kind, bool planar) {
  switch (kind) {
    case LoopKind::point:
    case LoopKind::spherical:
      return planar ? JointKind::revolute : JointKind::spherical;
    case LoopKind::revolute:
      return JointKind::revolute;
    case LoopKind::weld:
      return JointKind::weld;
    case LoopKind::prismatic:
      return JointKind::prismatic;
    case LoopKind::universal:
      return JointKind::universal;
    case LoopKind::cylindrical:
      return JointKind::cylindrical;
    case LoopKind::planar:
      return JointKind::planar;
    case LoopKind::distance:
    case LoopKind::coupler:
    case LoopKind::slot:
    case LoopKind::cam:
    case LoopKind::rack:
    case LoopKind::equation:
    case LoopKind::velocity_equation:
    case LoopKind::rolling:
      break;
  }
  return std::nullopt;
}

std::optional<LoopKind> as_loop(JointKind kind, bool planar) {
  switch (kind) {
    case JointKind::revolute:
      return LoopKind::revolute;
    case JointKind::prismatic:
      return LoopKind::prismatic;
    case JointKind::cylindrical:
      return LoopKind::cylindrical;
    case JointKind::universal:
      return LoopKind::universal;
    case JointKind::spherical:
      return LoopKind::spherical;
    case JointKind::planar:
      if (planar) break;
      return LoopKind::planar;
    case JointKind::weld:
      return LoopKind::weld;
    case JointKind::helical:
    case JointKind::free:
    case JointKind::user:
      break;
  }
  return std::nullopt;
}

int rows_of(JointKind kind, bool planar) {
  return (planar ? 3 : 6) - rates_of(kind);
}

RecutRestrictions::RecutRestrictions(const Scene& scene, const std::vector<std::string>& keep)
    : kept(keep.begin(), keep.end()) {
  for (const JointSpec& joint : scene.joints)
    if (joint.stiffness != 0 || joint.damping != 0 || joint.friction != 0 || joint.bearing ||
        has_stops(joint) || has_rotor(joint))
      of_coordinates.insert(joint.name);
  for (const DriveSpec& drive : scene.drives)
    (drive.joint.empty() ? driven_loops.insert(drive.loop) : of_coordinates.insert(drive.joint));
  for (const ForceSpec& force : scene.forces)
    if (force.kind == "torque")
      of_coordinates.insert(force.joint);
    else if (force.kind == "coordinate-spring")
      of_coordinates.insert(force.joints.begin(), force.joints.end());
  for (const LoopSpec& loop : scene.loops)
    of_coordinates.insert(loop.joints.begin(), loop.joints.end());
  of_coordinates.insert(scene.held.begin(), scene.held.end());
  in_formulas = NamedInFormulas(scene).joints;
  of_coordinates.insert(in_formulas.begin(), in_formulas.end());
  std::vector<std::string_view> known;
  for (const JointSpec& joint : scene.joints) known.push_back(joint.name);
  for (const LoopSpec& loop : scene.loops) known.push_back(loop.name);
  std::sort(known.begin(), known.end());
  for (const std::string& name : keep)
    if (!std::binary_search(known.begin(), known.end(), name))
      throw SceneError(scene.where({}) + "joint or loop " + reading::in_quotes(name) +
                       ", to be kept, is not in the scene, expected the name of one" +
                       reading::did_you_mean(name, known));
}

namespace {

/// A joint of this kind in the place of a loop.
JointSpec with_frames_of(const LoopSpec& loop, JointKind kind) {
  JointSpec joint;
  joint.name = loop.name;
  joint.kind = kind;
  joint.parent = loop.parent;
  joint.child = loop.child;
  joint.origin_parent = loop.origin_parent;
  joint.origin_child = loop.origin_child;
  joint.rotation = loop.rotation;
  joint.axis = loop.axis;
  joint.axis2 = loop.axis2;
  joint.direction = loop.direction;
  return joint;
}

}  // namespace

std::optional<JointSpec> joint_of(const LoopSpec& loop, const Mechanism& mechanism,
                                  const BodyMotions& bodies, double length) {
  const auto kind = as_joint(loop.kind, mechanism.plan().planar);
  if (!kind) return std::nullopt;
  JointSpec joint = with_frames_of(loop, *kind);
  const BodyMotion &parent = bodies.of(loop.parent), &child = bodies.of(loop.child);
  if (*kind == JointKind::revolute && loop.kind != LoopKind::revolute)
    joint.axis = (parent.pose.linear() * loop.rotation.toRotationMatrix()).transpose() *
                 mechanism.plan().basis.col(2);
  const JointMotion m = joint_motion(joint, parent, child);
  // A hinge closes with its axes reversed as well; across the plane of a planar mechanism points
  // may lie apart.
  if (m.tilt > 1e-8 || m.shift > 1e-8 * length) return std::nullopt;
  joint.position = m.q;
  joint.velocity = m.u;
  return joint;
}

LoopSpec loop_of(const JointSpec& joint) {
  LoopSpec loop;
  loop.name = joint.name;
  loop.kind = *as_loop(joint.kind, false);
  loop.parent = joint.parent;
  loop.child = joint.child;
  loop.origin_parent = joint.origin_parent;
  loop.origin_child = joint.origin_child;
  loop.rotation = joint.rotation;
  loop.axis = joint.axis;
  loop.axis2 = joint.axis2;
  loop.direction = joint.direction;
  return loop;
}

std::vector<JointSpec> joints_at(const Mechanism& mechanism, const Start& start) {
  std::vector<JointSpec> joints = mechanism.scene().joints;
  std::unordered_map<std::string, JointSpec*> by_name;
  for (JointSpec& joint : joints) {
    by_name[joint.name] = &joint;
    const auto nq = static_cast<std::size_t>(coordinates_of(joint)),
               nv = static_cast<std::size_t>(rates_of(joint));
    if (joint.position.empty()) {
      joint.position.assign(nq, 0.0);
      if (joint.kind == JointKind::spherical || joint.kind == JointKind::free)
        joint.position[nq - 4] = 1;
    }
    if (joint.velocity.empty()) joint.velocity.assign(nv, 0.0);
  }
  for (const Tree::Body& b : mechanism.tree().bodies) {
    JointSpec& joint = *by_name.at(b.joint);
    const auto first = static_cast<std::size_t>(b.parts > 1 ? b.coordinate : 0);
    for (int i = 0; i < b.nq; ++i)
      joint.position[first + static_cast<std::size_t>(i)] = start.q[b.q + i];
    for (int i = 0; i < b.nv; ++i)
      joint.velocity[first + static_cast<std::size_t>(i)] = start.u[b.u + i];
  }
  return joints;
}

bool turn_round(JointSpec& joint, Scene& scene, const RecutRestrictions& said,
                const BodyMotions& bodies) {
  if (joint.bearing && joint.bearing->length > 0) return false;  // bearings lie on the child
  if (joint.kind == JointKind::user) return false;               // its formula is that of the child
  if (!keeps_coordinates(joint.kind)) {
    if (said.of_coordinates.contains(joint.name)) return false;
    joint = reversed(joint);
    const JointMotion m = joint_motion(joint, bodies.of(joint.parent), bodies.of(joint.child));
    joint.position = m.q;
    joint.velocity = m.u;
    scene.remarks.push_back("joint '" + joint.name +
                            "' is counted from its other body: its coordinates mean others");
    return true;
  }
  // formulas name the two angles of a universal joint as they are
  if (joint.kind == JointKind::universal && said.in_formulas.contains(joint.name)) return false;
  joint = reversed(joint);
  if (joint.kind != JointKind::universal) return true;
  for (DriveSpec& drive : scene.drives)
    if (drive.joint == joint.name) drive.coordinate = 1 - drive.coordinate;
  for (LoopSpec& loop : scene.loops)
    for (std::size_t i = 0; i < loop.joints.size(); ++i)
      if (loop.joints[i] == joint.name) {
        loop.coordinates.resize(loop.joints.size());
        loop.coordinates[i] = 1 - loop.coordinates[i];
      }
  for (ForceSpec& force : scene.forces)
    for (std::size_t i = 0; i < force.joints.size(); ++i)
      if (force.joints[i] == joint.name) {
        force.coordinates.resize(force.joints.size());
        force.coordinates[i] = 1 - force.coordinates[i];
      }
  scene.remarks.push_back("joint '" + joint.name +
                          "' is counted from its other body: its two angles have changed places");
  return true;
}

}  // namespace momenta
