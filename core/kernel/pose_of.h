#pragma once
// Frame of a scene's body in ground axes: the pose of the kernel's body, and the turn from the
// kernel's axes to the scene's.

#include <momenta/core/kernel/sweeps.h>
#include <momenta/core/tree/tree.h>

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

}  // namespace momenta
