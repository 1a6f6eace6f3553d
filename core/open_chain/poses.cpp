#include <momenta/core/kernel/place_links.h>
#include <momenta/core/kernel/points.h>
#include <momenta/core/open_chain/poses.h>

namespace momenta {

struct Poses::Impl {
  Tree tree;
  Model<Spatial> model;
  Workspace<Spatial, double> w;
  Impl(Tree of, const Scene& scene)
      : tree(std::move(of)), model(build_spatial_model(tree, scene)), w(model) {}
};

Poses::Poses(const Tree& tree, const Scene& scene) : impl_(std::make_unique<Impl>(tree, scene)) {}
Poses::~Poses() = default;

std::vector<Eigen::Isometry3d> Poses::operator()(double t, const double* q) {
  auto& [tree, model, w] = *impl_;
  poses_outward(w, t, q, true);
  std::vector<Eigen::Isometry3d> all;
  for (std::size_t k = 0; k < tree.bodies.size(); ++k)
    all.push_back(pose_of(tree.bodies[k], model, w, k));
  return all;
}

void Poses::move(double t, const double* q, const double* u) {
  poses_outward(impl_->w, t, q, true);
  velocities_outward(impl_->w, u);
}

BodyMotion Poses::motion(int body) const {
  const auto& [tree, model, w] = *impl_;
  const auto k = static_cast<std::size_t>(body);
  BodyMotion motion;
  motion.pose = pose_of(tree.bodies[k], model, w, k);
  Vec3<double> origin;
  for (int i = 0; i < 3; ++i) origin[i] = motion.pose.translation()[i];
  const Vec3<double> v = point_velocity(w, body, origin), omega = angular_velocity(w, body);
  for (int i = 0; i < 3; ++i) motion.v[i] = v[i], motion.omega[i] = omega[i];
  return motion;
}

}  // namespace momenta
