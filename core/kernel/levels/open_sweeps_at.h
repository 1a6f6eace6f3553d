#pragma once
// OpenSweeps at one level; included only by files compiled for it. Their types must carry the level
// (Pack<W, L>): a function shared with the rest of the library could be linked from here and stop
// on a lesser machine. A test looks for such.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/branches/branch_accelerations.h>
#include <momenta/core/kernel/branches/branch_momenta.h>
#include <momenta/core/kernel/composite_sweeps.h>
#include <momenta/core/kernel/inverse_dynamics_sweeps.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/kernel/levels/lazy.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/levels/strided.h>
#include <momenta/core/kernel/planar_acceleration_sweeps.h>

namespace momenta {

template <class Tree, class Space, int Level>
class OpenSweepsAt final : public OpenSweeps {
  using One = Pack<1, Level>;
  static constexpr int branch_lanes = branch_lanes_at(Level);
  using Branch = Pack<branch_lanes, Level>;

 public:
  OpenSweepsAt(const Tree& tree, const Branches* branches)
      : tree_(tree),
        momentum_(tree),
        acceleration_(tree),
        scratch_(3 * static_cast<std::size_t>(tree.model->nv)),
        place_(static_cast<std::size_t>(tree.model->nq)) {
    for (const auto& b : tree.model->bodies) has_user_joints_ |= b.kind == JointKind::user;
    if (!branches) return;
    if constexpr (Space::dimension == 6) {
      branched_momenta_ = std::make_unique<BranchedMomenta<Branch, One>>(tree, *branches);
      branched_accelerations_ =
          std::make_unique<BranchedAccelerations<Branch, One>>(tree, *branches);
    }
  }

  bool momentum(double t, const double* q, const double* p, double* u, double* pdot) override {
    if constexpr (Space::dimension == 6)
      if (branched_momenta_) {
        keep_place(t, q);
        const bool ok = (*branched_momenta_)(t, StridedIn<One>{q, 1}, StridedIn<One>{p, 1},
                                             StridedOut<One>{u, 1}, StridedOut<One>{pdot, 1});
        if (!ok) singular_joint_ = branched_momenta_->singular_joint();
        return ok;
      }
    return body_by_body(t, q, p, u, pdot);
  }
  bool inverse_mass_times(double t, const double* q, const double* x, double* result) override {
    keep_place(t, q);
    return inverse_mass_times(x, result);
  }
  bool inverse_mass_times(const double* x, double* result) override {
    if (place_kept_) {
      const auto nv = static_cast<std::size_t>(tree_.model->nv);
      double *const u = &scratch_.data()->v, *const pdot = u + nv, *const no_momenta = pdot + nv;
      for (std::size_t i = 0; i < nv; ++i) no_momenta[i] = 0;
      if (!body_by_body(t_, &place_.data()->v, no_momenta, u, pdot)) return false;
    }
    momentum_.inverse_mass_times(StridedIn<One>{x, 1}, StridedOut<One>{result, 1});
    return true;
  }
  bool derivative(double t, const double* q, const double* p, const double* dq, const double* dp,
                  double* dqdot, double* dpdot) override {
    auto& along = along_.get(tree_);
    along.set(q, p);
    for (std::size_t i = 0; i < along.q.size(); ++i) along.q[i].b[0] = One(dq[i]);
    for (std::size_t i = 0; i < along.p.size(); ++i) along.p[i].b[0] = One(dp[i]);
    if (!along(t)) {
      singular_joint_ = along.singular_joint();
      return false;
    }
    for (std::size_t i = 0; i < along.q.size(); ++i) along.qdot[i].b[0].store(dqdot + i);
    for (std::size_t i = 0; i < along.p.size(); ++i) along.pdot[i].b[0].store(dpdot + i);
    return true;
  }
  bool acceleration(double t, const double* q, const double* u, const double* tau,
                    double* udot) override {
    if constexpr (Space::dimension == 6)
      if (branched_accelerations_) {
        const bool ok =
            (*branched_accelerations_)(t, StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                                       StridedIn<One>{tau, 1}, StridedOut<One>{udot, 1});
        if (!ok) singular_joint_ = branched_accelerations_->singular_joint();
        return ok;
      }
    const bool ok = acceleration_(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                                  StridedIn<One>{tau, 1}, StridedOut<One>{udot, 1});
    if (!ok) singular_joint_ = acceleration_.singular_joint();
    return ok;
  }

  bool composite_acceleration(double t, const double* q, const double* u, const double* tau,
                              double* udot) override {
    if constexpr (Space::dimension == 6)
      return !has_user_joints_ &&
             composite_.get(tree_)(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                                   StridedIn<One>{tau, 1}, StridedOut<One>{udot, 1});
    else
      return false;
  }
  bool inverse_dynamics(double t, const double* q, const double* u, const double* udot,
                        double* tau) override {
    if constexpr (Space::dimension == 6) {
      inverse_.get(tree_)(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                          StridedIn<One>{udot, 1}, StridedOut<One>{tau, 1});
      return true;
    } else {
      return false;
    }
  }

  int level() const override { return Level; }
  int singular_joint() const override { return singular_joint_; }

 private:
  bool body_by_body(double t, const double* q, const double* p, double* u, double* pdot) {
    place_kept_ = false;
    const bool ok = momentum_(One(t), StridedIn<One>{q, 1}, StridedIn<One>{p, 1},
                              StridedOut<One>{u, 1}, StridedOut<One>{pdot, 1});
    if (!ok) singular_joint_ = momentum_.singular_joint();
    return ok;
  }
  /// Remembers a place whose M* is not in momentum_, for inverse_mass_times().
  void keep_place(double t, const double* q) {
    place_kept_ = true;
    t_ = t;
    for (std::size_t i = 0; i < place_.size(); ++i) place_[i] = One(q[i]);
  }

  const Tree& tree_;
  std::unique_ptr<BranchedMomenta<Branch, One>> branched_momenta_;
  std::unique_ptr<BranchedAccelerations<Branch, One>> branched_accelerations_;
  MomentumSweeps<Space, One> momentum_;
  AccelerationSweeps<Space, One> acceleration_;
  struct None {};
  template <class Sweeps>
  using InSpace = Lazy<std::conditional_t<Space::dimension == 6, Sweeps, None>>;
  InSpace<CompositeSweeps<Spatial, One>> composite_;
  InSpace<InverseDynamicsSweeps<Spatial, One>> inverse_;
  Lazy<DirectionalPass<Space, 1, One>> along_;
  std::vector<One> scratch_, place_;
  double t_ = 0;
  bool place_kept_ = false;
  int singular_joint_ = -1;
  bool has_user_joints_ = false;
};

template <int Level>
std::unique_ptr<OpenSweeps> sweeps_at(const LinkTree& tree, const Branches* branches) {
  return std::make_unique<OpenSweepsAt<LinkTree, Spatial, Level>>(tree, branches);
}
template <int Level>
std::unique_ptr<OpenSweeps> sweeps_at(const PlanarTree& tree) {
  return std::make_unique<OpenSweepsAt<PlanarTree, Planar, Level>>(tree, nullptr);
}

}  // namespace momenta
