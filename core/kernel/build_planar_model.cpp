// The plane of a scene, and its tree in the planar algebra. Frames are parallel to the plane's
// basis when every joint is at zero, where all constants are read off.

#include <momenta/core/kernel/take_tree.h>
#include <momenta/core/scene/formula.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr double angle_tolerance = 1e-10;  // for axes typed with some ten digits [rad]

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() < angle_tolerance;
}
bool perpendicular(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) < angle_tolerance;
}

/// A right-handed basis with `normal` last; ground axes where the normal is one.
Eigen::Matrix3d basis_about(Eigen::Vector3d normal) {
  Eigen::Index largest;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal[largest] < 0) normal = -normal;
  Eigen::Matrix3d basis;
  if (parallel(normal, Eigen::Vector3d::Unit(largest))) {
    const Eigen::Index next = (largest + 1) % 3;
    basis << Eigen::Vector3d::Unit(next), Eigen::Vector3d::Unit((next + 1) % 3),
        Eigen::Vector3d::Unit(largest);
    return basis;
  }
  normal.normalize();
  const Eigen::Vector3d e1 = Eigen::Vector3d::Unit((largest + 1) % 3).cross(normal).normalized();
  basis << e1, normal.cross(e1), normal;
  return basis;
}

Vec2<double> vec2(const Eigen::Vector3d& v) {
  return {{v.x(), v.y()}};
}

/// Places of points of the scene's bodies, and directions, when every joint is at zero.
class ZeroPlaces {
 public:
  explicit ZeroPlaces(const Tree& tree) : tree_(tree), poses_(tree.zero_poses()) {}
  Eigen::Vector3d direction(const std::string& name, const Eigen::Vector3d& v) const {
    return pose(name).linear() * tree_.direction(tree_.body(name), v);
  }
  Eigen::Vector3d operator()(const std::string& name, const Eigen::Vector3d& point) const {
    return pose(name) * tree_.point(tree_.body(name), point);
  }

 private:
  Eigen::Isometry3d pose(const std::string& name) const {
    const int body = tree_.body(name);
    return body < 0 ? Eigen::Isometry3d::Identity() : poses_[static_cast<std::size_t>(body)];
  }

  const Tree& tree_;
  std::vector<Eigen::Isometry3d> poses_;
};

/// Whether gravity or a force may act along the normal, at zero positions and so at all.
bool loads_across(const Tree& tree, const Scene& scene, const Eigen::Vector3d& normal) {
  const ZeroPlaces place(tree);
  const auto across = [&](const Eigen::Vector3d& v) {
    return std::abs(v.dot(normal)) > angle_tolerance * v.norm();
  };
  const FormulaReader reader(scene);
  const auto pulls_across = [&](const Signal& s) {
    return s.kind == Signal::Kind::length ||
           (s.kind == Signal::Kind::position && std::abs(normal[s.component]) > angle_tolerance);
  };
  return across(scene.gravity) ||
         std::any_of(scene.forces.begin(), scene.forces.end(), [&](const ForceSpec& f) {
           if (f.kind == "potential") {
             const std::vector<Signal> signals = reader.read(f.law).signals;
             return std::any_of(signals.begin(), signals.end(), pulls_across);
           }
           if (f.kind == "wrench") {
             Eigen::Vector3d force = f.force;
             for (int i = 0; i < 3; ++i)
               if (!f.force_law[static_cast<std::size_t>(i)].empty()) force[i] = 1;
             return across(f.in_body_axes ? place.direction(f.body, force) : force);
           }
           return !f.child.empty() &&
                  across(place(f.child, f.origin_child) - place(f.parent, f.origin_parent));
         });
}

/// Whether masses, loops and forces lie in one plane, with the joint's point, so that none of them
/// has a moment across it.
bool is_flat(const Tree& tree, const Scene& scene, const JointSpec& joint,
             const Eigen::Vector3d& normal) {
  const ZeroPlaces place(tree);
  const Eigen::Vector3d from = place(joint.child, joint.origin_child);
  const auto level = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d arm = point - from;
    return std::abs(arm.dot(normal)) <= angle_tolerance * arm.norm();
  };
  for (const BodySpec& b : scene.bodies) {
    Eigen::Vector3d n;  // in its axes
    for (int i = 0; i < 3; ++i)
      n[i] = normal.dot(place.direction(b.name, Eigen::Vector3d::Unit(i)));
    if (b.mass > 0 && !level(place(b.name, b.com))) return false;
    if ((b.inertia * n).cross(n).norm() > angle_tolerance * b.inertia.norm()) return false;
  }
  for (const LoopSpec& l : scene.loops)
    if (ties_bodies(l) && !level(place(l.child, l.origin_child))) return false;
  return std::all_of(scene.forces.begin(), scene.forces.end(), [&](const ForceSpec& f) {
    if (f.kind == "wrench") return level(place(f.body, f.point));
    return f.child.empty() || level(place(f.child, f.origin_child));
  });
}

}  // namespace

PlaneFinding find_plane(const Tree& tree, const Scene& scene) {
  const auto poses = tree.zero_poses();
  std::optional<Eigen::Vector3d> normal;
  std::vector<Eigen::Vector3d> slides;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Tree::Body& b = tree.bodies[k];
    const Eigen::Vector3d z = poses[k].linear().col(2);
    if (Spatial::moves_freely(b.kind) || b.kind == JointKind::helical)
      return {{}, "joint '" + b.joint + "' moves in space"};
    if (b.kind == JointKind::revolute && !normal) normal = z;
    if (b.kind == JointKind::prismatic) slides.push_back(z);
  }
  if (!normal) {
    // The slide most inclined to the first one gives the sharpest normal.
    Eigen::Vector3d sharpest = Eigen::Vector3d::Zero();
    for (const auto& prismatic : slides)
      if (const Eigen::Vector3d n = slides.front().cross(prismatic); n.norm() > sharpest.norm())
        sharpest = n;
    if (sharpest.norm() >= angle_tolerance) normal = sharpest.normalized();
  }
  if (!normal) {
    // Slides along one line only: take the plane through it that holds gravity.
    const Eigen::Vector3d line = slides.empty() ? Eigen::Vector3d::UnitX() : slides.front();
    Eigen::Vector3d other = scene.gravity;
    if (other.norm() == 0 || parallel(line, other.normalized())) other = line.unitOrthogonal();
    normal = line.cross(other).normalized();
  }
  for (const ForceSpec& f : scene.forces)
    if (f.kind == "bushing" && f.rotational_stiffness != 0)
      return {{}, with_ends("bushing", f) + " has a rotational stiffness, which only space has"};
  for (const JointSpec& joint : scene.joints)
    if (joint.bearing && joint.bearing->length > 0 &&
        (joint.kind == JointKind::revolute || !is_flat(tree, scene, joint, *normal)))
      return {{}, "the bearing of joint '" + joint.name + "' carries moments out of the plane"};
  for (const JointSpec& joint : scene.joints)
    if (joint.bearing && joint.kind == JointKind::prismatic && loads_across(tree, scene, *normal))
      return {{}, "the bearing of joint '" + joint.name + "' carries loads out of the plane"};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Tree::Body& b = tree.bodies[k];
    const Eigen::Vector3d z = poses[k].linear().col(2);
    if (b.kind == JointKind::revolute && !parallel(z, *normal))
      return {{}, "the axis of joint '" + b.joint + "' is not normal to one common plane"};
    if (b.kind == JointKind::prismatic && !perpendicular(z, *normal))
      return {{}, "joint '" + b.joint + "' slides out of the plane of the others"};
  }
  return {basis_about(*normal), ""};
}

Model<Planar> build_planar_model(const Tree& tree, const Scene& scene,
                                 const Eigen::Matrix3d& basis) {
  Model<Planar> model;
  const std::size_t n = tree.bodies.size();
  model.basis = basis;
  take_joints(tree, model);
  const Eigen::Vector3d gravity = basis.transpose() * tree.gravity;
  model.gravity = vec2(gravity);
  model.has_gravity = gravity.head<2>().norm() > 0;

  const auto poses = tree.zero_poses();
  for (std::size_t k = 0; k < n; ++k) {
    const Tree::Body& b = tree.bodies[k];
    auto& m = model.bodies[k];
    const Eigen::Vector3d here = poses[k].translation();
    const Eigen::Vector3d from =
        b.parent < 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                     : Eigen::Vector3d(poses[static_cast<std::size_t>(b.parent)].translation());
    const Eigen::Vector3d r = basis.transpose() * (here - from);
    m.edge.x = r.x();
    m.edge.y = r.y();
    const Eigen::Vector3d axis = basis.transpose() * poses[k].linear().col(2);
    m.edge.sign = axis.z() < 0 ? -1 : 1;
    m.edge.prismatic_x = axis.x();
    m.edge.prismatic_y = axis.y();
    model.frames[k] = Eigen::Isometry3d::Identity();
    model.frames[k].linear() = basis.transpose() * poses[k].linear();
    model.frames[k].translation().z() = basis.col(2).dot(here);
    const Eigen::Vector3d c = model.frames[k].linear() * b.com;
    const Eigen::Matrix3d about_com =
        model.frames[k].linear() * b.inertia * model.frames[k].linear().transpose();
    m.inertia.m = b.mass;
    m.inertia.mc = vec2(b.mass * c);
    m.inertia.J = about_com(2, 2) + b.mass * c.head<2>().squaredNorm();
  }
  take_forces(tree, scene, model);
  return model;
}

template <>
Vec2<double> Model<Planar>::point(int body, const Eigen::Vector3d& p) const {
  return vec2(body < 0 ? Eigen::Vector3d(basis.transpose() * p)
                       : Eigen::Vector3d(frames[static_cast<std::size_t>(body)] * p));
}
template <>
Vec2<double> Model<Planar>::direction(int body, const Eigen::Vector3d& d) const {
  return vec2(body < 0 ? Eigen::Vector3d(basis.transpose() * d)
                       : Eigen::Vector3d(frames[static_cast<std::size_t>(body)].linear() * d));
}

}  // namespace momenta
