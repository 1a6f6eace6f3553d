#include <momenta/dae/gradient/kinetic_rates.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

namespace momenta {
namespace {

template <class Space>
class KineticRatesOf final : public KineticRates {
 public:
  explicit KineticRatesOf(Model<Space> model)
      : model_(std::move(model)), sweep_(make_kinetic_sweep(model_)) {}

  void along(double t, const double* q, const double* u, const double* v, double* rates,
             double* momenta) override {
    sweep_->along(t, q, u, v, rates, momenta);
  }

 private:
  Model<Space> model_;
  std::unique_ptr<KineticSweep> sweep_;
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
