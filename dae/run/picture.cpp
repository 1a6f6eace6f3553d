// The solids of a mechanism, its joints, loops, forces and markers, as pictures have them.

#include <momenta/core/scene/kinds.h>
#include <momenta/dae/mechanism/loop/pair_of_loop.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/run/picture_order.h>
#include <momenta/dae/run/upright.h>

#include <map>

namespace momenta {
namespace {

using Eigen::Vector3d;

constexpr double same_place = 1e-9;  // between two ends [m]

Picture::Turn turn_of(JointKind kind) {
  switch (kind) {
    case JointKind::weld:
    case JointKind::prismatic:
      return Picture::Turn::none;
    case JointKind::revolute:
    case JointKind::helical:
    case JointKind::cylindrical:
    case JointKind::planar:
      return Picture::Turn::about_axis;
    default:
      return Picture::Turn::freely;
  }
}
bool can_translation(JointKind kind) {
  return kind != JointKind::weld && kind != JointKind::revolute && kind != JointKind::universal &&
         kind != JointKind::spherical;
}

void add_end(std::vector<Vector3d>& ends, const Vector3d& point) {
  for (const Vector3d& other : ends)
    if ((other - point).norm() < same_place) return;
  ends.push_back(point);
}

}  // namespace

Picture picture_of(const Mechanism& mechanism) {
  const Scene& scene = mechanism.scene();
  Picture picture;
  picture.planar = mechanism.plan().planar;
  picture.length = length_of(scene);
  if (picture.planar)
    picture.view = upright(mechanism.plan().basis, scene.gravity);
  else
    picture.view = (Eigen::Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();  // z is up
  const PictureOrder order(mechanism);
  std::map<std::string, const BodySpec*> specs;
  for (const BodySpec& body : scene.bodies) specs[body.name] = &body;
  for (const JointSpec* joint : order.joints) {
    Picture::Body body;
    const BodySpec& spec = *specs.at(joint->child);
    body.name = spec.name;
    body.joint = joint->name;
    body.joint_kind = reading::name_of(joint->kind);
    body.parent = order.place.at(joint->parent);
    body.at_parent = joint->origin_parent;
    body.at_child = joint->origin_child;
    body.limits = joint->limits;
    body.turn = turn_of(joint->kind);
    body.translations = can_translation(joint->kind);
    body.rest = joint->rotation;
    body.axis = joint->axis.normalized();
    body.sprung = joint->stiffness != 0;
    body.damped = joint->damping != 0;
    body.shape = spec.shape;
    body.mass = spec.mass;
    body.com = spec.com;
    picture.bodies.push_back(body);
  }
  const auto hold = [&](int body, const Vector3d& point) {
    if (body >= 0) add_end(picture.bodies[static_cast<std::size_t>(body)].ends, point);
  };
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const Picture::Body body = picture.bodies[k];
    hold(static_cast<int>(k), body.at_child);
    hold(body.parent, body.at_parent);
  }
  const auto pair = [&](const auto& spec, const std::string& kind) {
    Picture::Pair p{spec.name,
                    kind,
                    order.place.at(spec.parent),
                    order.place.at(spec.child),
                    spec.origin_parent,
                    spec.origin_child};
    hold(p.parent, p.at_parent);
    hold(p.child, p.at_child);
    return p;
  };
  const auto draw = [&](const std::string& body, DrawnCurves::Polyline& line) {
    if (!line.points.empty())
      picture.strokes.push_back({order.place.at(body), std::move(line.points), line.closed});
  };
  for (const LoopSpec& loop : scene.loops) {
    if (loop.kind != LoopKind::slot && !has_curves(loop)) continue;
    DrawnCurves curves = drawn_curves(loop, 0.5 * picture.length);
    draw(loop.parent, curves.of_parent);
    draw(loop.child, curves.of_child);
  }
  for (const LoopSpec& loop : scene.loops)
    if (ties_bodies(loop))
      picture.loops.push_back(pair(loop, std::string(reading::name_of(loop.kind))));
    else if (loop.kind == LoopKind::coupler)
      picture.couplers.push_back({loop.name, {}, loop.ratios});
  std::size_t coupler = 0;
  std::map<std::string, int> by_joint;
  for (std::size_t k = 0; k < picture.bodies.size(); ++k)
    by_joint[picture.bodies[k].joint] = static_cast<int>(k);
  for (const LoopSpec& loop : scene.loops) {
    if (loop.kind != LoopKind::coupler) continue;
    for (const std::string& joint : loop.joints)
      picture.couplers[coupler].bodies.push_back(by_joint.at(joint));
    ++coupler;
  }
  for (const DriveSpec& drive : scene.drives)
    if (!drive.joint.empty())
      picture.bodies[static_cast<std::size_t>(by_joint.at(drive.joint))].driven = true;
  for (const ForceSpec& force : scene.forces) {
    if (force.kind == "spring-damper")
      picture.springs.push_back(pair(force, !force.law.empty()     ? force.kind
                                            : force.damping == 0   ? "spring"
                                            : force.stiffness == 0 ? "damper"
                                                                   : force.kind));
    if (force.kind == "torque")
      picture.bodies[static_cast<std::size_t>(by_joint.at(force.joint))].pushed = true;
    if (force.kind == "wrench")
      picture.loads.push_back(
          {order.place.at(force.body), force.point, force.force, force.torque, force.in_body_axes});
  }
  for (const VisualSpec& visual : scene.visuals)
    picture.solids.push_back({order.place.at(visual.body), visual});
  for (const MarkerSpec& marker : scene.markers)
    picture.markers.push_back({marker.name, order.place.at(marker.body), marker.point});
  for (Picture::Body& body : picture.bodies) {
    if (body.shape.kind == "rod") {
      add_end(body.ends, Vector3d::Zero());
      add_end(body.ends, body.shape.size.x() * body.shape.axis);
    }
    if (body.ends.size() < 2) add_end(body.ends, body.com);
  }
  return picture;
}

}  // namespace momenta
