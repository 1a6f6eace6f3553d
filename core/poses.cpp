#include <momenta/core/kernel/pose_of.h>
#include <momenta/core/poses.h>

namespace momenta {

Scene open_chain_of(Scene scene) {
  scene.loops.clear();
  std::erase_if(scene.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
  return scene;
}

struct Poses::Inside {
  Tree tree;
  Model<Spatial> model;
  Workspace<Spatial, double> w;
  explicit Inside(const Scene& scene)
      : tree(build_tree(scene)), model(build_spatial_model(tree, scene)), w(model) {}
};

Poses::Poses(const Scene& open_chain) : inside_(std::make_unique<Inside>(open_chain)) {}
Poses::~Poses() = default;

std::vector<Eigen::Isometry3d> Poses::operator()(double t, const double* q) {
  auto& [tree, model, w] = *inside_;
  poses_outward(w, t, q, true);
  std::vector<Eigen::Isometry3d> all;
  for (std::size_t k = 0; k < tree.bodies.size(); ++k)
    all.push_back(pose_of(tree.bodies[k], model, w, k));
  return all;
}

}  // namespace momenta
