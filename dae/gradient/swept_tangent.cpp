#include <momenta/dae/factor/faded_pivot.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/gradient/swept_tangent.h>
#include <momenta/dae/sweeps/levels/loop_sweeps.h>

namespace momenta {
namespace {

template <class Space>
using TreeOf = decltype(build_links(std::declval<const Model<Space>&>()));

template <class Space>
class SweptTangentOf final : public SweptTangent {
 public:
  SweptTangentOf(const Mechanism& mechanism, Model<Space> built)
      : model_(std::move(built)),
        links_(build_links(model_)),
        swept_(swept_loops(
            mechanism.tree(), model_,
            in_link_frames(build_loops(mechanism.scene(), mechanism.tree(), model_), links_))) {
    if (!swept_.plan.fits()) return;
    sweeps_ =
        make_tangent_sweeps(links_, swept_, fade_beside(fade_evaluation, mechanism.masses_apart()),
                            mechanism.has_body_forces());
    for (auto* x : {&u, &du, &dpdot}) x->resize(static_cast<std::size_t>(mechanism.nv()));
    for (auto* x : {&sigma, &dsigma}) x->resize(static_cast<std::size_t>(mechanism.m()));
  }
  /// Whether a front holds the slots.
  bool fits() const { return sweeps_ != nullptr; }

  bool operator()(double t, const double* q, const double* p, const double* dq,
                  const double* dp) override {
    if (!(*sweeps_)(t, q, p, dq, dp,
                    {u.data(), du.data(), dpdot.data(), sigma.data(), dsigma.data()}))
      return false;
    for (auto* x : {&sigma, &dsigma}) {
      if (!swept_.shared.empty()) swept_.shared.to_given(x->data(), 1);
      if (!swept_.carried.all()) swept_.carried.to_given(x->data(), 1, nullptr);
    }
    return true;
  }

 private:
  Model<Space> model_;
  TreeOf<Space> links_;
  SweptLoops<Space> swept_;
  std::unique_ptr<TangentSweeps> sweeps_;
};

template <class Space>
std::unique_ptr<SweptTangent> made(const Mechanism& mechanism, Model<Space> built) {
  auto tangent = std::make_unique<SweptTangentOf<Space>>(mechanism, std::move(built));
  if (!tangent->fits()) return nullptr;
  return tangent;
}

}  // namespace

std::unique_ptr<SweptTangent> make_swept_tangent(const Mechanism& mechanism) {
  if (mechanism.scene().lagrangian || mechanism.plan().quasi_velocities) return nullptr;
  if (mechanism.m() > 0 && mechanism.kkt() != KktChoice::sweeps) return nullptr;
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar) {
    if (mechanism.has_forces_apart()) return nullptr;
    return made(mechanism, build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  }
  if (mechanism.has_body_forces()) return nullptr;
  return made(mechanism, build_spatial_model(tree, mechanism.scene()));
}

}  // namespace momenta
