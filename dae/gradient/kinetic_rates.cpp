#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/gradient/kinetic_rates.h>

#include <vector>

namespace momenta {
namespace {

using Tangent = Dual<double, 1>;

template <class Space>
class KineticRatesOf final : public KineticRates {
 public:
  explicit KineticRatesOf(Model<Space> model)
      : model_(std::move(model)),
        w_(model_),
        q_(static_cast<std::size_t>(model_.nv)),
        u_(q_.size()),
        p_(q_.size()) {}

  void along(double t, const double* q, const double* u, const double* v, double* result) override {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      q_[i].a = q[i];
      u_[i].a = u[i], u_[i].b[0] = v[i];
    }
    poses_outward(w_, Tangent(t), q_.data(), false);
    velocities_outward(w_, u_.data());
    body_momenta(w_);
    momenta_inward(w_, p_.data());
    for (auto& body : w_.body) body.T = {};
    momentum_rates_inward(w_, q_.data(), u_.data(), p_.data());
    for (const auto& b : model_.bodies)
      if (b.nv == 1) {
        const auto at = static_cast<std::size_t>(b.u);
        p_[at] -= joint_force(b, q_[static_cast<std::size_t>(b.q)], u_[at]);
      }
    for (std::size_t i = 0; i < q_.size(); ++i) result[i] = p_[i].b[0];
  }

 private:
  Model<Space> model_;
  Workspace<Space, Tangent> w_;
  std::vector<Tangent> q_, u_, p_;
};

}  // namespace

std::unique_ptr<KineticRates> make_kinetic_rates(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar)
    return std::make_unique<KineticRatesOf<Planar>>(
        build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  return std::make_unique<KineticRatesOf<Spatial>>(build_spatial_model(tree, mechanism.scene()));
}

}  // namespace momenta
