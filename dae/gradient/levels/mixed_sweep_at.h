#pragma once
// MixedSweep at one level: the terms of (13) of docs/theory/gradients.md stand in four lanes of one
// register, each with its direction, at the same pose:
//
//   lane   u        σ     δq  δu  δσ
//   0      u + sν   sμ    u   u̇   λ
//   1      u − sν   −sμ   u   u̇   λ      (0 less 1) / 2s: D_c D_(0,ν,μ), and D_(0,ν,μ) of values
//   2      u        0     ν   0   0      D_(ν,0,0), with the weights
//   3      0        μ     u   0   0      Φ_qᵀμ and its rate
//
// Forces that do not depend on u are the same in lanes 0 and 1. Included by the files that are
// compiled for a level, and nowhere else.

#include <momenta/core/kernel/sweeps.h>
#include <momenta/core/scalar/sine_cosine.h>
#include <momenta/dae/gradient/levels/mixed_sweep.h>
#include <momenta/dae/gradient/levels/number_sweep_at.h>

#include <vector>

namespace momenta {

template <class Space, int Level>
class MixedSweepAt final : public MixedSweep {
  static constexpr int axes = Space::dimension == 6 ? 3 : 2;
  using Lanes = Pack<4, Level>;
  using S = Directions<4, Level>;
  using Vector = typename Space::template Vector<S>;

 public:
  MixedSweepAt(const Model<Space>& model, const LoopModel<Space>& loops, bool joint_forces)
      : model_(model),
        joint_forces_(joint_forces),
        w_(model),
        loops_(loops, w_),
        q_(static_cast<std::size_t>(model.nv)),
        u_(q_.size()),
        p_(q_.size()),
        pdot_(q_.size()),
        sigma_(static_cast<std::size_t>(loops.rows)) {}

  void operator()(const At& at, const Result& result) override {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const double u = at.u[i], away = at.s * at.nu[i];
      q_[i] = lanes({at.q[i], at.q[i], at.q[i], at.q[i]}, {u, u, at.nu[i], u});
      u_[i] = lanes({u + away, u - away, u, 0}, {at.udot[i], at.udot[i], 0, 0});
    }
    for (std::size_t i = 0; i < sigma_.size(); ++i) {
      const double mu = at.mu[i], lambda = at.lambda[i];
      sigma_[i] = lanes({at.s * mu, -at.s * mu, 0, mu}, {lambda, lambda, 0, 0});
    }
    poses_outward(w_, S(at.t), q_.data(), true);
    velocities_outward(w_, u_.data());
    body_momenta(w_);
    weights();
    loops_.place(sigma_.data());
    loops_.hand_to_bodies();
    momenta_inward(w_, p_.data());
    momentum_rates_inward(w_, q_.data(), u_.data(), pdot_.data());
    if (!joint_forces_)
      for (const auto& b : model_.bodies)
        if (b.nv == 1) {
          const auto i = static_cast<std::size_t>(b.u);
          pdot_[i] -= joint_force(b, q_[static_cast<std::size_t>(b.q)], u_[i]);
        }
    const double half = 1 / (2 * at.s);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const S &P = p_[i], &R = pdot_[i];
      result.by_q[i] = half * (R.b[0].lane(0) - R.b[0].lane(1)) - R.b[0].lane(2);
      result.by_u[i] =
          half * (P.b[0].lane(0) - P.b[0].lane(1) + R.a.lane(0) - R.a.lane(1)) - P.b[0].lane(2);
      result.force[i] = P.a.lane(3);
      result.rate[i] = P.b[0].lane(3);
    }
  }

 private:
  static S lanes(const double (&values)[4], const double (&slopes)[4]) {
    S x;
    x.a = Lanes::load(values);
    x.b[0] = Lanes::load(slopes);
    return x;
  }
  /// Adds weights to body[k].T, in lane 2.
  void weights() {
    if (model_.has_gravity) gravity_outward(w_);
    const S there = lanes({0, 0, 1, 0}, {0, 0, 0, 0});
    for (std::size_t k = 0; k < w_.body.size(); ++k) {
      w_.body[k].T = {};
      if (!model_.has_gravity) continue;
      const auto& inertia = w_.inertia(k);
      Vector mc;
      for (int i = 0; i < axes; ++i) mc[i] = inertia.mc[i] * there;
      w_.body[k].T = Space::weight(inertia.m * there, mc, w_.body[k].g);
    }
  }

  const Model<Space>& model_;
  bool joint_forces_;
  Workspace<Space, S> w_;
  LoopNumbers<Space, S> loops_;
  std::vector<S> q_, u_, p_, pdot_, sigma_;
};

template <int Level, class Space>
std::unique_ptr<MixedSweep> mixed_sweep_at(const Model<Space>& model, const LoopModel<Space>& loops,
                                           bool joint_forces) {
  return std::make_unique<MixedSweepAt<Space, Level>>(model, loops, joint_forces);
}

}  // namespace momenta
