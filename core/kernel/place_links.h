#pragma once
// Frame of a scene's body in ground axes: the pose of the kernel's body, and the turn from the
// kernel's axes to the scene's.

#include <momenta/core/kernel/general_joint.h>
#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/core/kernel/tree/tree.h>

#include <type_traits>

namespace momenta {

/// @pre poses_outward() with poses of all bodies
inline Eigen::Isometry3d pose_of(const Tree::Body& body, const Model<Spatial>& model,
                                 const Workspace<Spatial, double>& w, std::size_t k) {
  Eigen::Isometry3d pose;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pose.linear()(i, j) = w.body[k].pose.axes(i, j);
  for (int i = 0; i < 3; ++i) pose.translation()[i] = w.body[k].pose.origin[i];
  pose.makeAffine();
  return pose * model.frames[k] * body.scene_axes;
}
inline Eigen::Isometry3d pose_of(const Tree::Body& body, const Model<Planar>& model,
                                 const Workspace<Planar, double>& w, std::size_t k) {
  const auto& p = w.body[k].pose;
  Eigen::Isometry3d in_plane = Eigen::Isometry3d::Identity();
  in_plane.linear().topLeftCorner<2, 2>() << p.c, -p.s, p.s, p.c;
  in_plane.translation() << p.origin[0], p.origin[1], 0;
  Eigen::Isometry3d basis = Eigen::Isometry3d::Identity();
  basis.linear() = model.basis;
  return basis * in_plane * model.frames[k] * body.scene_axes;
}

// Places of a tree's joints at (t, q): the first step of every recursion. Angles of all joints on
// one axis are turned together, in packs.

/// Angle of the screw about z of a joint on one axis [rad], and shift along it [m].
template <class S>
MOMENTA_INLINE S angle_at(const Model<Spatial>::Body& b, const S& value) {
  return b.kind == JointKind::revolute || b.kind == JointKind::helical ? value + b.theta0
                                                                       : S(b.theta0);
}
template <class S>
MOMENTA_INLINE S shift_at(const Model<Spatial>::Body& b, const S& value) {
  if (b.kind == JointKind::prismatic) return value + b.d0;
  return b.kind == JointKind::helical ? b.pitch * value + b.d0 : S(b.d0);
}

/// Axes of a spherical joint: the constant turn c and the joint's q as one quaternion c ∘ q.
template <class S, class In>
MOMENTA_INLINE Mat3<S> spherical_axes(const SphericalPlace& place, const In& q, int first) {
  const S w = q[first], x = q[first + 1], y = q[first + 2], z = q[first + 3];
  if (!place.turned) return rotation_by(w, x, y, z);
  const double* c = place.turn;
  return rotation_by<S>(
      c[0] * w - c[1] * x - c[2] * y - c[3] * z, c[0] * x + c[1] * w + c[2] * z - c[3] * y,
      c[0] * y + c[2] * w + c[3] * x - c[1] * z, c[0] * z + c[3] * w + c[1] * y - c[2] * x);
}

/// Instead of axes: spherical joints are placed where a sweep meets them.
struct WhereMet {};

/// Sines and cosines of revolute joints among the first n links, turned axes of spherical joints
/// (`axes(record)`, unless WhereMet), edges of the others.
template <class S, class In, class Axes>
void place_links(const LinkTree& tree, const S& t, const In& q, Angles<S>& angles,
                 std::vector<JointRecord<Spatial, S>>& joints, std::vector<UserRecord<S>>& users,
                 Axes&& axes, std::size_t n) {
  const Link* links = tree.links.data();
  const double* theta0 = tree.theta0.data();
  constexpr bool where_met = std::is_same_v<std::remove_cvref_t<Axes>, WhereMet>;
  const bool revolutes_alone = joints.empty();
  for (std::size_t k = 0; tree.has_angles && k < n; ++k) {
    if (links[k].kind == LinkKind::revolute) {
      angles.set(k, q[links[k].q] + theta0[k]);
    } else if (revolutes_alone || !links[k].one_axis) {
      angles.set(k, S(0.0));
    } else {
      const auto& b = tree.model->bodies[k];
      auto& x = joints[static_cast<std::size_t>(links[k].record)];
      S value(0.0);
      if (b.drive >= 0) {
        prescribe(tree.model->drives[static_cast<std::size_t>(b.drive)], t, x.drive, x.drive_rate,
                  x.drive_acceleration);
        value = x.drive;
      } else if (b.nv > 0) {
        value = q[b.q];
      }
      x.edge.d = shift_at(b, value);
      angles.set(k, angle_at(b, value));
    }
  }
  if (tree.has_angles) angles.turn(n);
  if (revolutes_alone && (where_met || tree.sphericals.empty())) return;
  for (std::size_t k = 0; k < n; ++k) {
    if (links[k].kind == LinkKind::revolute) continue;
    const auto& b = tree.model->bodies[k];
    const auto record = static_cast<std::size_t>(links[k].record);
    if (links[k].kind == LinkKind::spherical) {
      if constexpr (!where_met) axes(record) = spherical_axes<S>(tree.sphericals[record], q, b.q);
      continue;
    }
    auto& x = joints[record];
    if (links[k].one_axis) {
      x.edge.cos_theta = angles.cosine(k);
      x.edge.sin_theta = angles.sine(k);
      continue;
    }
    S at[7]{};
    for (int i = 0; i < b.nq; ++i) at[i] = q[b.q + i];
    if (b.law) {
      x.user = &users[static_cast<std::size_t>(b.user)];
      Joint<Spatial>::place(b, t, static_cast<const S*>(at), x.user->motion, x.edge);
    } else {
      Joint<Spatial>::place<S>(b, nullptr, at[0], at, x.edge);
    }
  }
}
/// The same for all links.
template <class S, class In, class Axes>
void place_links(const LinkTree& tree, const S& t, const In& q, Angles<S>& angles,
                 std::vector<JointRecord<Spatial, S>>& joints, std::vector<UserRecord<S>>& users,
                 Axes&& axes) {
  place_links(tree, t, q, angles, joints, users, axes, angles.size());
}

}  // namespace momenta
