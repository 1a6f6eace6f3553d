#include <momenta/core/kernel/points.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/measure/whole.h>

namespace momenta {
namespace {

Eigen::Vector3d eigen(const Vec3<double>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Whole whole(const Tree& tree, const Scene& scene, double t, const Eigen::VectorXd& q,
            const Eigen::VectorXd& u) {
  const Model<Spatial> model = build_spatial_model(tree, scene);
  Workspace<Spatial, double> w(model);
  poses_outward(w, t, q.data(), true);
  velocities_outward(w, u.data());
  Whole all;
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const int body = static_cast<int>(k);
    const auto& inertia = w.inertia(k);
    const auto momentum = Spatial::momentum(inertia, w.body[k].V);
    const Eigen::Vector3d at = eigen(origin(w, body)),
                          linear = eigen(to_ground(w, body, momentum.f));
    all.mass += inertia.m;
    all.centre += inertia.m * at + eigen(to_ground(w, body, inertia.mc));
    all.linear_momentum += linear;
    all.angular_momentum += eigen(to_ground(w, body, momentum.n)) + at.cross(linear);
  }
  all.centre /= all.mass;
  return all;
}

}  // namespace momenta
