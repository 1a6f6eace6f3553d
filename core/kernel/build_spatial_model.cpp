// Canonical frames in space. The transform from a parent's frame to a joint, (R, r), is written as
//
//   Rz(γ)Tz(δ) Rx(α)Tx(a) Rz(θ)Tz(d)      where the z axes are inclined: a along the common normal
//   Rz(γ)Tz(δ) Rx(α)Tx(a) Ry(β) Rz(θ)     where they are parallel or nearly so: the common normal
//                                         would be far away
//
// The frame of a body on a joint about or along z may be turned and shifted along z; that freedom
// makes γ = δ = 0 for its first child. Spherical and free bodies keep the scene's axes: their
// quaternion is the scene's.

#include <momenta/core/kernel/take_tree.h>

#include <cmath>

namespace momenta {
namespace {

/// Sine of the inclination below which axes count as parallel: the foot of their common normal lies
/// up to (length of the edge) / sine away, and inertias about it lose the square.
constexpr double nearly_parallel = 0.3;

struct Screws {
  double gamma = 0, delta = 0, alpha = 0, a = 0, beta = 0, theta = 0, d = 0;
};

Eigen::Matrix3d about(int axis, double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
}

Screws decompose(const Eigen::Isometry3d& t) {
  const Eigen::Vector3d z = t.linear().col(2), r = t.translation();
  const double inclination = std::hypot(z.x(), z.y());
  Screws s;
  if (inclination >= nearly_parallel) {
    s.gamma = std::atan2(z.x(), -z.y());
    s.alpha = std::atan2(inclination, z.z());
    s.a = r.x() * std::cos(s.gamma) + r.y() * std::sin(s.gamma);
    s.d = (r.x() * std::sin(s.gamma) - r.y() * std::cos(s.gamma)) / inclination;
    s.delta = r.z() - s.d * z.z();
  } else {
    s.a = std::hypot(r.x(), r.y());
    s.gamma = s.a > 0 ? std::atan2(r.y(), r.x()) : 0.0;
    s.delta = r.z();
    const Eigen::Vector3d seen = about(2, -s.gamma) * z;
    s.beta = std::asin(seen.x());
    s.alpha = std::atan2(-seen.y(), seen.z());
  }
  const Eigen::Matrix3d rest =
      (about(2, s.gamma) * about(0, s.alpha) * about(1, s.beta)).transpose() * t.linear();
  s.theta = std::atan2(rest(1, 0), rest(0, 0));
  const double length = r.norm();
  for (double* shift : {&s.delta, &s.a, &s.d})
    if (std::abs(*shift) < 1e-15 * length) *shift = 0;
  return s;
}

/// Cosine and sine, exact at multiples of a right angle up to rounding of the angle; true: there is
/// a turn.
bool trigonometry(double angle, double& c, double& s) {
  c = std::cos(angle);
  s = std::sin(angle);
  if (std::abs(s) < 1e-15) {
    s = 0;
    c = c > 0 ? 1 : -1;
  } else if (std::abs(c) < 1e-15) {
    c = 0;
    s = s > 0 ? 1 : -1;
  }
  return !(c == 1 && s == 0);
}

Spatial::EdgeConstants edge_of(const Screws& s) {
  Spatial::EdgeConstants e;
  e.delta = s.delta;
  e.a = s.a;
  e.about_z = trigonometry(s.gamma, e.cos_gamma, e.sin_gamma) || s.delta != 0;
  e.about_x = trigonometry(s.alpha, e.cos_alpha, e.sin_alpha) || s.a != 0;
  e.about_y = trigonometry(s.beta, e.cos_beta, e.sin_beta);
  return e;
}

bool turns_about_z(JointKind kind) {
  return !Spatial::moves_freely(kind);
}

Vec3<double> vec3(const Eigen::Vector3d& v) {
  return {{v.x(), v.y(), v.z()}};
}

Spatial::RigidInertia<double> inertia_in(const Tree::Body& b, const Eigen::Isometry3d& frame) {
  const Eigen::Vector3d c = frame * b.com;
  const Eigen::Matrix3d j =
      frame.linear() * b.inertia * frame.linear().transpose() +
      b.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  Spatial::RigidInertia<double> r;
  r.m = b.mass;
  r.mc = vec3(b.mass * c);
  for (int i = 0; i < 3; ++i)
    for (int k = i; k < 3; ++k) r.J(i, k) = j(i, k);
  return r;
}

}  // namespace

Model<Spatial> build_spatial_model(const Tree& tree, const Scene& scene) {
  Model<Spatial> model;
  const std::size_t n = tree.bodies.size();
  take_joints(tree, model);
  model.gravity = vec3(tree.gravity);
  model.has_gravity = tree.gravity.norm() > 0;

  // The first child of a body free to be turned and shifted along its z decides how.
  std::vector<double> turn(n, 0.0), shift(n, 0.0);
  std::vector<bool> decided(n, false);
  for (const Tree::Body& b : tree.bodies) {
    const auto parent = static_cast<std::size_t>(b.parent);
    if (b.parent < 0 || decided[parent]) continue;
    decided[parent] = true;
    if (!turns_about_z(tree.bodies[parent].kind)) continue;
    const Screws s = decompose(b.placement);
    turn[parent] = s.gamma;
    shift[parent] = s.delta;
    model.frames[parent].linear() = about(2, -s.gamma);
    model.frames[parent].translation().z() = -s.delta;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Tree::Body& b = tree.bodies[k];
    auto& m = model.bodies[k];
    const Eigen::Isometry3d parent_frame = b.parent < 0
                                               ? Eigen::Isometry3d::Identity()
                                               : model.frames[static_cast<std::size_t>(b.parent)];
    Screws s = decompose(parent_frame * b.placement);
    if (std::abs(std::sin(s.gamma)) < 1e-14 && std::cos(s.gamma) > 0) s.gamma = 0;
    if (std::abs(s.delta) < 1e-14 * b.placement.translation().norm()) s.delta = 0;
    m.edge = edge_of(s);
    m.theta0 = s.theta + turn[k];
    m.d0 = s.d + shift[k];
    m.inertia = inertia_in(b, model.frames[k]);
  }
  take_forces(tree, scene, model);
  return model;
}

template <>
Vec3<double> Model<Spatial>::point(int body, const Eigen::Vector3d& p) const {
  return vec3(body < 0 ? p : Eigen::Vector3d(frames[static_cast<std::size_t>(body)] * p));
}
template <>
Vec3<double> Model<Spatial>::direction(int body, const Eigen::Vector3d& d) const {
  return vec3(body < 0 ? d : Eigen::Vector3d(frames[static_cast<std::size_t>(body)].linear() * d));
}

}  // namespace momenta
