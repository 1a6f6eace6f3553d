#include <momenta/core/scalar/dual_choice.h>
#include <momenta/dae/factor/faded_pivot.h>
#include <momenta/dae/gradient/swept_tangent.h>
#include <momenta/dae/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/sweeps/spatial_loop_sweeps.h>

namespace momenta {
namespace {

using Tangent = Dual<double, 1>;

struct In {
  const Tangent* x;
  const Tangent& operator[](int i) const { return x[i]; }
};
struct Out {
  Tangent* x;
  Tangent& operator[](int i) const { return x[i]; }
};

template <class Space>
using TreeOf = decltype(build_links(std::declval<const Model<Space>&>()));

/// What the sweeps read; it stays where it is.
template <class Space>
struct SweptModel {
  SweptModel(const Mechanism& mechanism, Model<Space> built)
      : model(std::move(built)),
        links(build_links(model)),
        swept(swept_loops(
            mechanism.tree(), model,
            in_link_frames(build_loops(mechanism.scene(), mechanism.tree(), model), links))) {}
  Model<Space> model;
  TreeOf<Space> links;
  SweptLoops<Space> swept;
};

template <class Space, int Rows>
class SweptTangentOf final : public SweptTangent {
 public:
  SweptTangentOf(const Mechanism& mechanism, std::unique_ptr<SweptModel<Space>> model)
      : model_(std::move(model)),
        sweeps_(model_->links, model_->swept.loops, model_->swept.plan),
        fade_(fade_beside(fade_evaluation, mechanism.masses_apart())),
        with_forces_(mechanism.has_body_forces()),
        q_(static_cast<std::size_t>(mechanism.nv())),
        p_(q_.size()),
        u_(q_.size()),
        pdot_(q_.size()),
        sigma_(static_cast<std::size_t>(mechanism.m())) {
    for (auto* x : {&u, &du, &dpdot}) x->resize(q_.size());
    dsigma.resize(sigma_.size());
  }

  bool operator()(double t, const double* q, const double* p, const double* dq,
                  const double* dp) override {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      q_[i].a = q[i], q_[i].b[0] = dq[i];
      p_[i].a = p[i], p_[i].b[0] = dp[i];
    }
    RightSide<Tangent> right;
    right.fade = fade_;
    right.rates = true;
    right.body_forces = with_forces_;
    if (!sweeps_(Tangent(t), In{q_.data()}, In{p_.data()}, In{p_.data()}, right, Out{u_.data()},
                 Out{sigma_.data()}, Out{pdot_.data()}) ||
        sweeps_.weak_looped_branch())
      return false;
    for (std::size_t i = 0; i < q_.size(); ++i) {
      u[i] = u_[i].a;
      du[i] = u_[i].b[0];
      dpdot[i] = pdot_[i].b[0];
    }
    for (std::size_t i = 0; i < sigma_.size(); ++i) dsigma[i] = sigma_[i].b[0];
    if (!model_->swept.shared.empty()) model_->swept.shared.to_given(dsigma.data(), 1);
    if (!model_->swept.carried.all()) model_->swept.carried.to_given(dsigma.data(), 1, nullptr);
    return true;
  }

 private:
  std::unique_ptr<SweptModel<Space>> model_;
  LoopSweeps<Space, Tangent, Rows, true> sweeps_;
  double fade_;
  bool with_forces_;
  std::vector<Tangent> q_, p_, u_, pdot_, sigma_;
};

/// Null where no front holds the slots. Of slots apart only those in use are computed, so that few
/// widths do.
template <class Space>
std::unique_ptr<SweptTangent> made(const Mechanism& mechanism, Model<Space> built) {
  auto model = std::make_unique<SweptModel<Space>>(mechanism, std::move(built));
  const LoopPlan& plan = model->swept.plan;
  if (!plan.fits()) return nullptr;
  constexpr int narrow = Space::dimension == 3 ? 4 : 8;
  if (plan.slots <= narrow)
    return std::make_unique<SweptTangentOf<Space, narrow>>(mechanism, std::move(model));
  return std::make_unique<SweptTangentOf<Space, LoopPlan::most_slots>>(mechanism, std::move(model));
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
