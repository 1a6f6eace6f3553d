#include <momenta/core/open_chain/centroidal.h>
#include <momenta/core/open_chain/centroidal_sums.h>

namespace momenta {

struct CentroidalSweep::Impl {
  Model<Spatial> model;
  Workspace<Spatial, double> w;
  Impl(const Tree& tree, const Scene& scene) : model(build_spatial_model(tree, scene)), w(model) {}
};

CentroidalSweep::CentroidalSweep(const Tree& tree, const Scene& scene)
    : impl_(std::make_unique<Impl>(tree, scene)) {}
CentroidalSweep::~CentroidalSweep() = default;
CentroidalSweep::CentroidalSweep(CentroidalSweep&&) noexcept = default;
CentroidalSweep& CentroidalSweep::operator=(CentroidalSweep&&) noexcept = default;

Centroidal CentroidalSweep::operator()(double t, const double* q, const double* u) {
  return centroidal_of(centroidal_sums(impl_->w, t, q, u));
}

Centroidal centroidal(const Tree& tree, const Scene& scene, double t, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& u) {
  return CentroidalSweep(tree, scene)(t, q.data(), u.data());
}

}  // namespace momenta
