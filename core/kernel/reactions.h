#pragma once
// Joint reactions from one dual-number pass, eq. (28), which the paper announces as its next step:
//
//   T_r,K = d/dt P*_K + Ω_K × P*_K − T*_K
//
// P*_K is a function of (q, p, t), its rate the derivative along (q̇, ṗ, 1): the momentum recursion
// on numbers a + b ε gives u and u̇ at once, P* = Σ M Ω gives P* and its rate. Accelerations of
// drives come in through t. No acceleration-level equation is needed; Newton-Euler in
// accelerations.h is the check.
//
// T_r,K acts at O_K from the parent on body K, along the joint too: Eᵀ T_r is its spring, damper
// and torque, or the force of its drive.

#include <momenta/core/kernel/momentum_recursion.h>

#include <vector>

namespace momenta {

template <class Space>
class ReactionPass {
 public:
  using D = Dual<double, 1>;
  using Links = decltype(build_links(std::declval<const Model<Space>&>()));

  explicit ReactionPass(const Links& links)
      : sweeps_(links),
        w_(*links.model),
        q_(static_cast<std::size_t>(links.model->nq)),
        p_(static_cast<std::size_t>(links.model->nv)),
        u_(p_.size()),
        pdot_(p_.size()) {}

  /// Takes q, q̇ (nq), p, ṗ (nv) of one state of the motion. False as momentum_recursion. O(bodies),
  /// about ten plain evaluations.
  bool operator()(double t, const double* q, const double* qdot, const double* p,
                  const double* pdot) {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      q_[i] = D(q[i]);
      q_[i].b[0] = qdot[i];
    }
    for (std::size_t i = 0; i < p_.size(); ++i) {
      p_[i] = D(p[i]);
      p_[i].b[0] = pdot[i];
    }
    const D time = D::variable(t, 0);
    if (!sweeps_(time, q_.data(), p_.data(), u_.data(), pdot_.data())) return false;
    const auto& model = *w_.model;
    poses_outward(w_, time, q_.data(), true);
    velocities_outward(w_, u_.data());
    body_momenta(w_);
    momenta_inward(w_, static_cast<D*>(nullptr));
    gravity_outward(w_);
    apply_forces(w_, model.has_body_forces());
    for (std::size_t k = w_.body.size(); k-- > 0;) {
      const auto& b = model.bodies[k];
      if (b.parent >= 0)
        w_.body[static_cast<std::size_t>(b.parent)].T +=
            Space::to_parent(b.edge, b.kind, w_.body[k].edge, w_.body[k].T);
    }
    return true;
  }

  /// T_r of body k in the axes and about the origin the sweeps use for it.
  typename Space::template Force<double> reaction(std::size_t k) const {
    const auto& s = w_.body[k];
    auto turning = Space::cross_force(s.V, s.P);
    if constexpr (Space::dimension == 3) turning.f = {};  // components along ground axes
    typename Space::template Force<double> f;
    for (int i = 0; i < Space::dimension; ++i) f[i] = s.P[i].b[0] + turning[i].a - s.T[i].a;
    return f;
  }
  /// u̇_i, from the same pass.
  double acceleration(std::size_t i) const { return u_[i].b[0]; }

 private:
  MomentumSweeps<Space, D> sweeps_;
  Workspace<Space, D> w_;
  std::vector<D> q_, p_, u_, pdot_;
};

}  // namespace momenta
