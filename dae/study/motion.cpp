#include <momenta/core/poses.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/dae/loop/loop_choice.h>
#include <momenta/dae/loop/pair_of_loop.h>
#include <momenta/dae/study/motion.h>
#include <momenta/dae/study/upright.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double same_place = 1e-9;  // [m] of two ends

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

/// The joints of a scene, parents first, and which place a body has in that order.
struct Order {
  std::vector<const JointSpec*> joints;
  std::map<std::string, int> place{{"ground", -1}};

  explicit Order(const Mechanism& mechanism) {
    std::map<std::string, const JointSpec*> by_child;
    for (const JointSpec& joint : mechanism.scene().joints) by_child[joint.child] = &joint;
    for (const Tree::Body& body : mechanism.tree().bodies)
      if (!body.name.empty()) {
        place[body.name] = static_cast<int>(joints.size());
        joints.push_back(by_child.at(body.name));
      }
  }
};

/// What a loop leaves free between its points, and what drives prescribe of it.
class LoopGap {
 public:
  LoopGap(const Scene& scene, const LoopSpec& loop) : loop_(loop) {
    for (const DriveSpec& drive : scene.drives)
      if (drive.loop == loop.name) drives_.push_back({MotionLaw(drive), drive});
    const Vector3d axis = loop.axis.normalized();
    const Eigen::Matrix3d frame = frame_across(loop);
    switch (loop.kind) {
      case LoopKind::slot:
      case LoopKind::cam:
      case LoopKind::rack:
        if (has_curves(loop))
          pair_ = pair_of(loop);
        else
          free_ = {axis};
        break;
      case LoopKind::prismatic:
      case LoopKind::cylindrical:
        free_ = {axis};
        break;
      case LoopKind::planar:
        free_ = {frame.col(0), frame.col(1)};
        break;
      default:
        break;
    }
  }

  Vector3d gap(double t, const Isometry3d& parent, const Isometry3d& child) {
    Vector3d at_parent = loop_.origin_parent;
    double length = loop_.length;
    std::vector<double> given(free_.size(), std::nan(""));
    for (const auto& [law, drive] : drives_) {
      double f = 0, unused = 0;
      law.evaluate(t, f, unused, unused);
      const auto coordinate = static_cast<std::size_t>(drive.coordinate);
      if (!drive.origin.empty())
        at_parent[drive.origin[0] - 'x'] = f;
      else if (loop_.kind == LoopKind::distance)
        length = f;
      else if (coordinate < given.size())
        given[coordinate] = f;
    }
    Vector3d apart = child * loop_.origin_child - parent * at_parent;
    if (loop_.kind == LoopKind::distance)
      return apart.norm() > 0 ? Vector3d(apart * (1 - length / apart.norm())) : apart;
    const Eigen::Matrix3d frame = parent.linear() * loop_.rotation.toRotationMatrix();
    if (loop_.kind == LoopKind::rolling) return of_wheel(frame * loop_.normal, child, apart);
    if (pair_) return of_pair(frame * frame_across(loop_), child, apart);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const Vector3d way = frame * free_[i];
      apart -= (std::isnan(given[i]) ? apart.dot(way) : given[i]) * way;
    }
    return apart;
  }

 private:
  /// Between the wheel and its plane.
  Vector3d of_wheel(const Vector3d& normal, const Isometry3d& child, const Vector3d& apart) const {
    const Vector3d axle = child.linear() * loop_.axis.normalized();
    const double circle = loop_.radius - loop_.crown_radius;
    return (normal.dot(apart) - loop_.crown_radius - circle * normal.cross(axle).norm()) * normal;
  }
  /// F along its gradient in the plane; of a slot also what leads out of it. `axes`: columns e₁, e₂
  /// and the normal.
  Vector3d of_pair(const Eigen::Matrix3d& axes, const Isometry3d& child, const Vector3d& apart) {
    const Vector3d in_axes = axes.transpose() * apart;
    const Vector3d turned = axes.transpose() * (child.linear() * frame_across(loop_).col(0));
    PairTerms<double> terms;
    pair_->evaluate({in_axes[0], in_axes[1], turned[0], turned[1]}, place_, terms);
    const double square = terms.slope[0] * terms.slope[0] + terms.slope[1] * terms.slope[1];
    Vector3d gap = terms.value / square * Vector3d(terms.slope[0], terms.slope[1], 0);
    if (loop_.kind == LoopKind::slot) gap[2] = in_axes[2];
    return gap.allFinite() ? Vector3d(axes * gap) : Vector3d(Vector3d::Zero());
  }
  struct Prescribed {
    MotionLaw law;
    DriveSpec drive;
  };
  const LoopSpec& loop_;
  std::vector<Prescribed> drives_;
  std::vector<Vector3d> free_;  ///< directions in the joint frame, by coordinate
  std::optional<HigherPair> pair_;
  PairPlace place_;
};

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
  const Order order(mechanism);
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

Motion motion_of(const Mechanism& mechanism, const Film& film) {
  Poses poses_at(mechanism.tree(), mechanism.scene());
  const Order order(mechanism);
  std::vector<std::size_t> in_tree;
  for (const JointSpec* joint : order.joints)
    in_tree.push_back(static_cast<std::size_t>(mechanism.tree().body(joint->child)));
  std::vector<LoopGap> gaps;
  std::vector<std::pair<int, int>> sides;
  for (const LoopSpec& loop : mechanism.scene().loops)
    if (ties_bodies(loop)) {
      gaps.emplace_back(mechanism.scene(), loop);
      sides.push_back({order.place.at(loop.parent), order.place.at(loop.child)});
    }

  Motion motion;
  motion.start = film.start;
  motion.every = film.every;
  for (const std::vector<double>& q : film.frames) {
    const double t = film.start + film.every * static_cast<double>(motion.frames.size());
    const auto poses = poses_at(t, q.data());
    const auto of = [&](int k) -> Isometry3d {
      return k < 0 ? Isometry3d::Identity() : poses[in_tree[static_cast<std::size_t>(k)]];
    };
    Motion::Frame frame;
    for (std::size_t k = 0; k < order.joints.size(); ++k) {
      const JointSpec& joint = *order.joints[k];
      const Isometry3d relative =
          of(order.place.at(joint.parent)).inverse() * of(static_cast<int>(k));
      frame.turn.push_back(Quaterniond(relative.linear()).normalized());
      frame.translation.push_back(relative * joint.origin_child);
    }
    for (std::size_t i = 0; i < gaps.size(); ++i)
      frame.gap.push_back(gaps[i].gap(t, of(sides[i].first), of(sides[i].second)));
    motion.frames.push_back(std::move(frame));
  }
  return motion;
}

std::vector<Isometry3d> places(const Picture& picture, const Motion::Frame& frame) {
  std::vector<Isometry3d> all;
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    const Isometry3d parent =
        body.parent < 0 ? Isometry3d::Identity() : all[static_cast<std::size_t>(body.parent)];
    Isometry3d place = Isometry3d::Identity();
    place.linear() = parent.linear() * frame.turn[k].toRotationMatrix();
    place.translation() = parent * frame.translation[k] - place.linear() * body.at_child;
    all.push_back(place);
  }
  return all;
}

namespace {

/// Largest turn and shift of bodies against their parents between frames that lie `stride` apart.
std::pair<double, double> largest_change(const Motion& motion, std::size_t stride) {
  double turn = 0, shift = 0;
  for (std::size_t i = stride; i < motion.frames.size(); i += stride)
    for (std::size_t k = 0; k < motion.frames[i].turn.size(); ++k) {
      const auto &a = motion.frames[i - stride], &b = motion.frames[i];
      turn = std::max(turn, a.turn[k].angularDistance(b.turn[k]));
      shift = std::max(shift, (a.translation[k] - b.translation[k]).norm());
    }
  return {turn, shift};
}

}  // namespace

void thin(Motion& motion, const Picture& picture) {
  constexpr double fine_turn = 0.2, fine_shift = 0.1;
  constexpr std::size_t enough = 200;
  std::size_t stride = 1;
  while ((motion.frames.size() - 1) % (2 * stride) == 0 && motion.frames.size() / stride > enough) {
    const auto [turn, shift] = largest_change(motion, 2 * stride);
    if (turn > fine_turn || shift > fine_shift * picture.length) break;
    stride *= 2;
  }
  if (stride == 1) return;
  std::vector<Motion::Frame> kept;
  for (std::size_t i = 0; i < motion.frames.size(); i += stride)
    kept.push_back(std::move(motion.frames[i]));
  motion.frames = std::move(kept);
  motion.every *= static_cast<double>(stride);
}

double largest_turn(const Motion& motion) {
  return largest_change(motion, 1).first;
}

}  // namespace momenta
