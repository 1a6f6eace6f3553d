#pragma once
// The rows of a mechanism's equations by sweeps, for one algebra and one scalar: what forms
// evaluate, in doubles, and differentiate, in every other scalar. Included only where it is
// instantiated.

#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/mechanism/bearings.h>
#include <momenta/dae/mechanism/lagrangian_rows.h>
#include <momenta/dae/mechanism/loop/loop_rows.h>
#include <momenta/dae/mechanism/model_data.h>

namespace momenta {

template <class Space, class S>
class Mechanism::SweepRows : public Evaluation<S> {
 public:
  SweepRows(const Mechanism& mechanism, const ModelData<Space>& data)
      : model_(data.model),
        w_(data.model),
        loops_(data.loops, w_),
        bearings_(mechanism.scene(), mechanism.tree()),
        still_(static_cast<std::size_t>(mechanism.nv())) {}

  void place(double t, const S* q) override {
    poses_outward(w_, Moment<S>::at(t), q, true);
    loops_.place(t, q);
    gravity_current_ = false;
  }
  void positions(S* phi) override { loops_.positions(phi); }

  void move(const S* u) override {
    velocities_outward(w_, u ? u : still_.data());
    loops_.move(u);
  }
  void velocities(S* rate) override { loops_.velocities(rate); }

  void momenta(const S* sigma, S* p) override {
    body_momenta(w_);
    if (sigma) loops_.add_wrenches(sigma, 1.0, [](auto& body) -> Force& { return body.P; });
    momenta_inward(w_, p);
    if (sigma) loops_.add_couplings(sigma, 1.0, p);
  }

  void momentum_rates(const S* q, const S* u, const S* sigma, double leak, S* pdot) override {
    apply();
    if (sigma) {
      loops_.add_inertial_rates(sigma);
      if (leak != 0) loops_.add_wrenches(sigma, -leak, [](auto& body) -> Force& { return body.T; });
    }
    momentum_rates_inward(w_, q, u, pdot);
    if (sigma) loops_.add_coupling_rates(sigma, pdot);
    if (sigma && leak != 0) loops_.add_couplings(sigma, -leak, pdot);
  }

  void joint_forces(const S* q, const S* u, const S* udot, const S* lambda, S* tau) override {
    accelerations_outward(w_, u, udot);
    apply();
    // Φ_qᵀλ stands on the left of (1a): as an applied wrench it is −λ.
    if (lambda) loops_.add_wrenches(lambda, -1.0, [](auto& body) -> Force& { return body.T; });
    newton_euler_inward(w_, q, u, tau);
    if (lambda) loops_.add_couplings(lambda, 1.0, tau);
    loops_.accelerate(udot);
  }
  void accelerations(S* rate) override { loops_.accelerations(rate); }
  void bearing_friction(const S* u, S* tau) override { bearings_.add_friction(w_, u, tau); }

  void constraint_forces(const S* x, S* result) override {
    for (auto& body : w_.body) body.P = {};
    loops_.add_wrenches(x, 1.0, [](auto& body) -> Force& { return body.P; });
    project_inward(w_, result);
    loops_.add_couplings(x, 1.0, result);
  }

  void coordinate_rates(const S* q, const S* u, S* qdot) const override {
    momenta::coordinate_rates(model_, q, u, qdot);
  }
  void joint_rates(const S* q, const S* qdot, S* u) const override {
    momenta::joint_rates(model_, q, qdot, u);
  }

  void applied_forces(double t, const S* q, const S* u, S* tau, bool at_points) override {
    momenta::applied_forces(w_, Moment<S>::at(t), q, u, at_points);
    std::copy(w_.generalised.begin(), w_.generalised.end(), tau);
  }

 protected:
  using Force = typename Space::template Force<S>;

  const Model<Space>& model_;
  Workspace<Space, S> w_;
  LoopRows<Space, S> loops_;
  Bearings<Space> bearings_;

 private:
  void apply() {
    if (model_.has_gravity && !gravity_current_) {
      gravity_outward(w_);
      gravity_current_ = true;
    }
    apply_forces(w_, model_.has_body_forces());
  }

  std::vector<S> still_;
  bool gravity_current_ = false;
};

template <class S>
std::unique_ptr<Evaluation<S>> Mechanism::evaluation() const {
  if (scene_.lagrangian) return std::make_unique<LagrangianRows<S>>(lagrangian());
  return visit([&]<class Space>(const ModelData<Space>& data) -> std::unique_ptr<Evaluation<S>> {
    return std::make_unique<SweepRows<Space, S>>(*this, data);
  });
}

}  // namespace momenta
