#include "simbody_system.h"

#include <SimTKsimbody.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace momenta::benchmark_models {
namespace {

using SimTK::Constraint, SimTK::MobilizedBody, SimTK::Rotation, SimTK::Transform, SimTK::UnitVec3,
    SimTK::Vec3;

Vec3 vector(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

Rotation rotation(const Eigen::Quaterniond& q) {
  return Rotation(SimTK::Quaternion(q.w(), q.x(), q.y(), q.z()));
}

/// Across `axis`.
Vec3 across(const Eigen::Vector3d& axis) {
  return vector(perpendicular_to(axis).normalized());
}

SimTK::Body::Rigid rigid(const BodySpec& body) {
  const Eigen::Matrix3d& about_com = body.inertia;
  const SimTK::Inertia inertia(about_com(0, 0), about_com(1, 1), about_com(2, 2), about_com(0, 1),
                               about_com(0, 2), about_com(1, 2));
  return SimTK::Body::Rigid(SimTK::MassProperties(
      body.mass, vector(body.com), inertia.shiftFromMassCenter(-vector(body.com), body.mass)));
}

struct Joint {
  JointKind kind;
  MobilizedBody body;
  Rotation child;  ///< child axes in the joint frame
};

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what + ": not translated to Simbody");
}

}  // namespace

struct SimbodySystem::Inside {
  Inside(const Scene& scene, bool planar);
  MobilizedBody& body(const std::string& name);
  void add_subtree(const Scene& scene, const std::string& root);
  void add_joint(const Scene& scene, const JointSpec& joint);
  void add_loop(const LoopSpec& loop, bool planar);

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::vector<std::string> names;
  std::vector<Joint> joints;
  SimTK::State state;
  SimTK::Vector q, u;
};

SimbodySystem::Inside::Inside(const Scene& scene, bool planar) {
  if (!scene.drives.empty()) refuse("a drive");
  if (!scene.forces.empty()) refuse("a force");
  SimTK::Force::UniformGravity(forces, matter, vector(scene.gravity));
  add_subtree(scene, "ground");
  for (const LoopSpec& loop : scene.loops) add_loop(loop, planar);
  state = system.realizeTopology();
  matter.setUseEulerAngles(state, false);
  system.realizeModel(state);
  q.resize(state.getNQ());
  u.resize(state.getNU());
}

MobilizedBody& SimbodySystem::Inside::body(const std::string& name) {
  if (name == "ground") return matter.Ground();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return joints[i].body;
  throw std::runtime_error("no joint carries body '" + name + "'");
}

// Depth first, as momenta orders q and u.
void SimbodySystem::Inside::add_subtree(const Scene& scene, const std::string& root) {
  for (const JointSpec& joint : scene.joints) {
    if (joint.parent != root) continue;
    add_joint(scene, joint);
    add_subtree(scene, joint.child);
  }
}

void SimbodySystem::Inside::add_joint(const Scene& scene, const JointSpec& joint) {
  if (joint.stiffness != 0 || joint.damping != 0 || joint.friction != 0 || joint.bearing ||
      has_stops(joint) || has_rotor(joint))
    refuse("joint '" + joint.name + "' with a spring, damper, friction, stop or rotor");
  const BodySpec* spec = nullptr;
  for (const BodySpec& b : scene.bodies)
    if (b.name == joint.child) spec = &b;
  MobilizedBody& parent = body(joint.parent);
  const Vec3 axis = vector(joint.axis);
  Rotation to_axis;
  if (joint.kind == JointKind::revolute)
    to_axis = Rotation(UnitVec3(axis), SimTK::ZAxis);
  else if (joint.kind == JointKind::prismatic)
    to_axis = Rotation(UnitVec3(axis), SimTK::XAxis);
  else if (joint.kind == JointKind::universal) {
    const Vec3 second = joint.axis2.isZero() ? across(joint.axis) : vector(joint.axis2);
    if (std::abs(SimTK::dot(axis, second)) > 1e-15)
      refuse("joint '" + joint.name + "' with axes that are not perpendicular");
    to_axis = Rotation(UnitVec3(axis), SimTK::XAxis, second, SimTK::YAxis);
  }
  const Transform in_parent(rotation(joint.rotation) * to_axis, vector(joint.origin_parent));
  const Transform in_child(to_axis, vector(joint.origin_child));
  const SimTK::Body::Rigid solid = rigid(*spec);
  MobilizedBody made;
  switch (joint.kind) {
    case JointKind::revolute:
      made = MobilizedBody::Pin(parent, in_parent, solid, in_child);
      break;
    case JointKind::prismatic:
      made = MobilizedBody::Slider(parent, in_parent, solid, in_child);
      break;
    case JointKind::universal:
      made = MobilizedBody::Universal(parent, in_parent, solid, in_child);
      break;
    case JointKind::spherical:
      made = MobilizedBody::Ball(parent, in_parent, solid, in_child);
      break;
    case JointKind::free:
      made = MobilizedBody::Free(parent, in_parent, solid, in_child);
      break;
    case JointKind::weld:
      made = MobilizedBody::Weld(parent, in_parent, solid, in_child);
      break;
    default:
      refuse("joint '" + joint.name + "' of this kind");
  }
  names.push_back(joint.child);
  joints.push_back({joint.kind, made, Rotation()});
}

void SimbodySystem::Inside::add_loop(const LoopSpec& loop, bool planar) {
  MobilizedBody &parent = body(loop.parent), &child = body(loop.child);
  const Vec3 at_parent = vector(loop.origin_parent), at_child = vector(loop.origin_child);
  const Rotation frame = rotation(loop.rotation);
  const Vec3 axis = vector(loop.axis), first = across(loop.axis),
             second = SimTK::cross(axis, first);
  const auto share_axis = [&] {
    for (const Vec3& v : {first, second})
      Constraint::ConstantAngle(parent, UnitVec3(frame * v), child, UnitVec3(axis), SimTK::Pi / 2);
  };
  switch (loop.kind) {
    case LoopKind::point:
    case LoopKind::spherical:
    case LoopKind::revolute:
      if (planar) {
        for (const Vec3& v : {Vec3(frame * first), Vec3(frame * second)})
          Constraint::PointInPlane(parent, UnitVec3(v), SimTK::dot(v, at_parent), child, at_child);
      } else {
        Constraint::Ball(parent, at_parent, child, at_child);
        if (loop.kind == LoopKind::revolute) share_axis();
      }
      break;
    case LoopKind::distance:
      Constraint::Rod(parent, at_parent, child, at_child, loop.length);
      break;
    case LoopKind::weld:
      Constraint::Weld(parent, Transform(frame, at_parent), child, Transform(at_child));
      break;
    default:
      refuse("loop '" + loop.name + "' of this kind");
  }
}

SimbodySystem::SimbodySystem(const Scene& scene, bool planar)
    : in_(std::make_unique<Inside>(scene, planar)) {}
SimbodySystem::~SimbodySystem() = default;

int SimbodySystem::rates() const {
  return in_->state.getNU();
}

int SimbodySystem::equations() const {
  return in_->state.getNUDotErr();
}

void SimbodySystem::set(const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  Eigen::Index iq = 0, iu = 0;
  for (Joint& joint : in_->joints) {
    const int nq = joint.body.getNumQ(in_->state), nu = joint.body.getNumU(in_->state);
    const int q0 = joint.body.getFirstQIndex(in_->state),
              u0 = joint.body.getFirstUIndex(in_->state);
    if (joint.kind == JointKind::spherical || joint.kind == JointKind::free) {
      const bool free = joint.kind == JointKind::free;
      const Eigen::Vector4d turn = q.segment<4>(iq + (free ? 3 : 0));
      joint.child = Rotation(SimTK::Quaternion(turn[0], turn[1], turn[2], turn[3]));
      const auto in_parent = [&](Eigen::Index from, int to) {
        const Vec3 rate = joint.child * Vec3(u[from], u[from + 1], u[from + 2]);
        for (int k = 0; k < 3; ++k) in_->u[to + k] = rate[k];
      };
      for (int k = 0; k < 4; ++k) in_->q[q0 + k] = turn[k];
      for (int k = 4; k < nq; ++k) in_->q[q0 + k] = q[iq + k - 4];
      in_parent(iu + (free ? 3 : 0), u0);
      if (free) in_parent(iu, u0 + 3);
    } else {
      for (int k = 0; k < nq; ++k) in_->q[q0 + k] = q[iq + k];
      for (int k = 0; k < nu; ++k) in_->u[u0 + k] = u[iu + k];
    }
    iq += nq;
    iu += nu;
  }
}

void SimbodySystem::evaluate() {
  in_->state.updQ() = in_->q;
  in_->state.updU() = in_->u;
  in_->system.realize(in_->state, SimTK::Stage::Acceleration);
}

Eigen::VectorXd SimbodySystem::accelerations() const {
  Eigen::VectorXd all(rates());
  const SimTK::Vector& found = in_->state.getUDot();
  Eigen::Index iu = 0;
  for (const Joint& joint : in_->joints) {
    const int nu = joint.body.getNumU(in_->state), u0 = joint.body.getFirstUIndex(in_->state);
    const auto in_child = [&](const SimTK::Vector& of, int from) {
      return Vec3(~joint.child * Vec3(of[from], of[from + 1], of[from + 2]));
    };
    const auto put = [&](Eigen::Index at, const Vec3& v) {
      all.segment<3>(at) << v[0], v[1], v[2];
    };
    if (joint.kind == JointKind::spherical) {
      put(iu, in_child(found, u0));
    } else if (joint.kind == JointKind::free) {
      const Vec3 omega = in_child(in_->u, u0), v = in_child(in_->u, u0 + 3);
      put(iu, in_child(found, u0 + 3) - SimTK::cross(omega, v));
      put(iu + 3, in_child(found, u0));
    } else {
      for (int k = 0; k < nu; ++k) all[iu + k] = found[u0 + k];
    }
    iu += nu;
  }
  return all;
}

}  // namespace momenta::benchmark_models
