#include <momenta/core/kernel/whole_sums.h>
#include <momenta/core/whole.h>

namespace momenta {

struct WholeSweep::Inside {
  Model<Spatial> model;
  Workspace<Spatial, double> w;
  Inside(const Tree& tree, const Scene& scene)
      : model(build_spatial_model(tree, scene)), w(model) {}
};

WholeSweep::WholeSweep(const Tree& tree, const Scene& scene)
    : inside_(std::make_unique<Inside>(tree, scene)) {}
WholeSweep::~WholeSweep() = default;
WholeSweep::WholeSweep(WholeSweep&&) noexcept = default;
WholeSweep& WholeSweep::operator=(WholeSweep&&) noexcept = default;

Whole WholeSweep::operator()(double t, const double* q, const double* u) {
  return whole_of(whole_sums(inside_->w, t, q, u));
}

Whole whole(const Tree& tree, const Scene& scene, double t, const Eigen::VectorXd& q,
            const Eigen::VectorXd& u) {
  return WholeSweep(tree, scene)(t, q.data(), u.data());
}

}  // namespace momenta
