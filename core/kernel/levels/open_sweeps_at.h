#pragma once
// OpenSweeps at one level; included by the files that are compiled for it, and nowhere else.
// Whatever code they emit must carry the level in its types (Pack<W, L>): a function they shared
// with the rest of the library could be linked in from here and stop on a lesser machine. A test
// looks for such.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/composite_sweeps.h>
#include <momenta/core/kernel/inverse_dynamics_sweeps.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/levels/strided.h>
#include <momenta/core/kernel/limbs/limb_accelerations.h>
#include <momenta/core/kernel/limbs/limb_momenta.h>
#include <momenta/core/kernel/planar_acceleration_sweeps.h>

#include <limits>

namespace momenta {

template <class Tree, class Space, int Level>
class OpenSweepsAt final : public OpenSweeps {
  static constexpr int lanes = native_width<Level>;
  using One = Pack<1, Level>;
  using Many = Pack<lanes, Level>;
  static constexpr int limb_lanes = limb_lanes_at(Level);
  using Limb = Pack<limb_lanes, Level>;

 public:
  OpenSweepsAt(const Tree& tree, const Limbs* limbs)
      : tree_(tree),
        momentum_(tree),
        acceleration_(tree),
        composite_(tree),
        inverse_(tree),
        along_(tree),
        jacobian_(tree),
        many_momenta_(tree),
        many_accelerations_(tree) {
    for (const auto& b : tree.model->bodies) {
      quasi_velocities_ |= b.nq != b.nv;
      has_user_joints_ |= b.kind == JointKind::user;
    }
    rates_.resize(3 * static_cast<std::size_t>(tree.model->nv));
    if (!limbs) return;
    if constexpr (Space::dimension == 6) {
      limbed_momenta_ = std::make_unique<LimbedMomenta<Limb, One>>(tree, *limbs);
      limbed_accelerations_ = std::make_unique<LimbedAccelerations<Limb, One>>(tree, *limbs);
    }
  }

  bool momentum(double t, const double* q, const double* p, double* u, double* pdot) override {
    if constexpr (Space::dimension == 6)
      if (limbed_momenta_) {
        const bool ok = (*limbed_momenta_)(t, StridedIn<One>{q, 1}, StridedIn<One>{p, 1},
                                           StridedOut<One>{u, 1}, StridedOut<One>{pdot, 1});
        if (!ok) stuck_ = limbed_momenta_->stuck();
        return ok;
      }
    const bool ok = momentum_(One(t), StridedIn<One>{q, 1}, StridedIn<One>{p, 1},
                              StridedOut<One>{u, 1}, StridedOut<One>{pdot, 1});
    if (!ok) stuck_ = momentum_.stuck();
    return ok;
  }
  bool inverse_mass_times(double t, const double* q, const double* x, double* result) override {
    const auto nv = static_cast<std::size_t>(tree_.model->nv);
    double* const no_momenta = rates_.data() + 2 * nv;
    for (std::size_t i = 0; i < nv; ++i) no_momenta[i] = 0;
    if (!momentum_(One(t), StridedIn<One>{q, 1}, StridedIn<One>{no_momenta, 1},
                   StridedOut<One>{rates_.data(), 1}, StridedOut<One>{rates_.data() + nv, 1})) {
      stuck_ = momentum_.stuck();
      return false;
    }
    momentum_.inverse_mass_times(StridedIn<One>{x, 1}, StridedOut<One>{result, 1});
    return true;
  }
  bool derivative(double t, const double* q, const double* p, const double* dq, const double* dp,
                  double* dqdot, double* dpdot) override {
    auto& along = along_.get();
    along.set(q, p);
    for (std::size_t i = 0; i < along.q.size(); ++i) along.q[i].b[0] = One(dq[i]);
    for (std::size_t i = 0; i < along.p.size(); ++i) along.p[i].b[0] = One(dp[i]);
    if (!along(t)) {
      stuck_ = along.stuck();
      return false;
    }
    for (std::size_t i = 0; i < along.q.size(); ++i) along.qdot[i].b[0].store(dqdot + i);
    for (std::size_t i = 0; i < along.p.size(); ++i) along.pdot[i].b[0].store(dpdot + i);
    return true;
  }
  bool jacobian(double t, const double* q, const double* p, double* J,
                std::ptrdiff_t stride) override {
    const bool ok = jacobian_.get()(t, q, p, J, stride);
    if (!ok) stuck_ = jacobian_.get().stuck();
    return ok;
  }
  bool acceleration(double t, const double* q, const double* u, const double* tau,
                    double* udot) override {
    if constexpr (Space::dimension == 6)
      if (limbed_accelerations_) {
        const bool ok = (*limbed_accelerations_)(t, StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                                                 StridedIn<One>{tau, 1}, StridedOut<One>{udot, 1});
        if (!ok) stuck_ = limbed_accelerations_->stuck();
        return ok;
      }
    const bool ok = acceleration_(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                                  StridedIn<One>{tau, 1}, StridedOut<One>{udot, 1});
    if (!ok) stuck_ = acceleration_.stuck();
    return ok;
  }

  bool composite_acceleration(double t, const double* q, const double* u, const double* tau,
                              double* udot) override {
    if constexpr (Space::dimension == 6)
      return !has_user_joints_ &&
             composite_.get()(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                              StridedIn<One>{tau, 1}, StridedOut<One>{udot, 1});
    else
      return false;
  }
  bool inverse_dynamics(double t, const double* q, const double* u, const double* udot,
                        double* tau) override {
    if constexpr (Space::dimension == 6) {
      inverse_.get()(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1}, StridedIn<One>{udot, 1},
                     StridedOut<One>{tau, 1});
      return true;
    } else {
      return false;
    }
  }

  bool momentum(double t, const States& s) override {
    return each_pack(s, [&](const double* q, const double* p, double* qdot, double* pdot,
                            std::ptrdiff_t stride) {
      const bool direct = !quasi_velocities_;  // q̇ = u
      const StridedOut<Many> u{direct ? qdot : rates_.data(), direct ? stride : lanes};
      if (!many_momenta_.get()(Many(t), StridedIn<Many>{q, stride}, StridedIn<Many>{p, stride}, u,
                               StridedOut<Many>{pdot, stride})) {
        stuck_ = many_momenta_.get().stuck();
        return false;
      }
      if (!direct) coordinate_rates(q, qdot, stride);
      return true;
    });
  }
  bool acceleration(double t, const States& s) override {
    return each_pack(
        s, [&](const double* q, const double* u, double*, double* udot, std::ptrdiff_t stride) {
          const bool ok = many_accelerations_.get()(Many(t), StridedIn<Many>{q, stride},
                                                    StridedIn<Many>{u, stride}, Nothing{},
                                                    StridedOut<Many>{udot, stride});
          if (!ok) stuck_ = many_accelerations_.get().stuck();
          return ok;
        });
  }

  int width() const override { return lanes; }
  int level() const override { return Level; }
  int stuck() const override { return stuck_; }
  std::size_t failed_state() const override { return failed_state_; }

 private:
  struct Nothing {
    MOMENTA_INLINE Many operator[](int) const { return Many(0.0); }
  };
  /// Workspaces of packs are large: made when a batch first asks for them.
  template <class Sweeps>
  class WhenAsked {
   public:
    explicit WhenAsked(const Tree& tree) : tree_(&tree) {}
    Sweeps& get() {
      if (!sweeps_) sweeps_ = std::make_unique<Sweeps>(*tree_);
      return *sweeps_;
    }

   private:
    const Tree* tree_;
    std::unique_ptr<Sweeps> sweeps_;
  };

  void coordinate_rates(const double* q, double* qdot, std::ptrdiff_t stride) {
    for (const auto& b : tree_.model->bodies) {
      if (b.nv == 0) continue;
      if (b.nq == b.nv) {
        for (int i = 0; i < b.nv; ++i)
          Many::load(rates_.data() + (b.u + i) * lanes).store(qdot + (b.q + i) * stride);
        continue;
      }
      Many at[7], rate[6], out[7];
      for (int i = 0; i < b.nq; ++i) at[i] = Many::load(q + (b.q + i) * stride);
      for (int i = 0; i < b.nv; ++i) rate[i] = Many::load(rates_.data() + (b.u + i) * lanes);
      momenta::coordinate_rates(b.kind, static_cast<const Many*>(at),
                                static_cast<const Many*>(rate), out);
      for (int i = 0; i < b.nq; ++i) out[i].store(qdot + (b.q + i) * stride);
    }
  }

  /// Calls f on every full pack in place, and on the rest in a padded copy. A pack that fails is
  /// repeated state by state, so that one bad state spoils no other.
  template <class F>
  bool each_pack(const States& s, F&& f) {
    const auto nq = static_cast<std::size_t>(tree_.model->nq);
    const auto nv = static_cast<std::size_t>(tree_.model->nv);
    rates_.resize(nv * lanes);
    bool all = true;
    std::size_t first = 0;
    for (; first + lanes <= s.count; first += lanes)
      if (!f(s.q + first, s.p + first, s.qdot ? s.qdot + first : nullptr, s.pdot + first, s.stride))
        all &= one_by_one(s, first, lanes, nq, nv, f, all);
    if (first < s.count && !copied(s, first, s.count - first, nq, nv, f))
      all &= one_by_one(s, first, s.count - first, nq, nv, f, all);
    return all;
  }

  /// `count` states from `first` on copied into one pack, the last repeated.
  template <class F>
  bool copied(const States& s, std::size_t first, std::size_t count, std::size_t nq, std::size_t nv,
              F&& f) {
    padded_.resize((2 * nq + 2 * nv) * lanes);
    double* const q = padded_.data();
    double* const p = q + nq * lanes;
    double* const qdot = p + nv * lanes;
    double* const pdot = qdot + nq * lanes;
    const auto at = [&](std::size_t i, std::size_t state) {
      return static_cast<std::ptrdiff_t>(i) * s.stride + static_cast<std::ptrdiff_t>(state);
    };
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t state = first + (lane < count ? lane : count - 1);
      for (std::size_t i = 0; i < nq; ++i) q[i * lanes + lane] = s.q[at(i, state)];
      for (std::size_t i = 0; i < nv; ++i) p[i * lanes + lane] = s.p[at(i, state)];
    }
    if (!f(q, p, qdot, pdot, lanes)) return false;
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (s.qdot)
        for (std::size_t i = 0; i < nq; ++i) s.qdot[at(i, first + lane)] = qdot[i * lanes + lane];
      for (std::size_t i = 0; i < nv; ++i) s.pdot[at(i, first + lane)] = pdot[i * lanes + lane];
    }
    return true;
  }
  template <class F>
  bool one_by_one(const States& s, std::size_t first, std::size_t count, std::size_t nq,
                  std::size_t nv, F&& f, bool none_failed_yet) {
    bool all = true;
    for (std::size_t state = first; state < first + count; ++state) {
      if (copied(s, state, 1, nq, nv, f)) continue;
      if (none_failed_yet && all) failed_state_ = state;
      all = false;
      const double nothing = __builtin_nan("");
      const auto place = static_cast<std::ptrdiff_t>(state);
      if (s.qdot)
        for (std::size_t i = 0; i < nq; ++i)
          s.qdot[static_cast<std::ptrdiff_t>(i) * s.stride + place] = nothing;
      for (std::size_t i = 0; i < nv; ++i)
        s.pdot[static_cast<std::ptrdiff_t>(i) * s.stride + place] = nothing;
    }
    return all;
  }

  /// Memory of the level's own type, so that no level shares the code of a vector of doubles.
  struct Buffer {
    std::vector<One> x;
    void resize(std::size_t n) {
      if (x.size() < n) x.resize(n);
    }
    double* data() { return &x.data()->v; }
  };

  const Tree& tree_;
  std::unique_ptr<LimbedMomenta<Limb, One>> limbed_momenta_;
  std::unique_ptr<LimbedAccelerations<Limb, One>> limbed_accelerations_;
  MomentumSweeps<Space, One> momentum_;
  AccelerationSweeps<Space, One> acceleration_;
  /// Nothing to ask for in a plane.
  struct None {
    explicit None(const Tree&) {}
  };
  template <class Sweeps>
  using InSpace = WhenAsked<std::conditional_t<Space::dimension == 6, Sweeps, None>>;
  InSpace<CompositeSweeps<Spatial, One>> composite_;
  InSpace<InverseDynamicsSweeps<Spatial, One>> inverse_;
  WhenAsked<DirectionalPass<Space, 1, One>> along_;
  WhenAsked<JacobianPass<Space, Many>> jacobian_;
  WhenAsked<MomentumSweeps<Space, Many>> many_momenta_;
  WhenAsked<AccelerationSweeps<Space, Many>> many_accelerations_;
  Buffer rates_, padded_;
  int stuck_ = -1;
  std::size_t failed_state_ = 0;
  bool quasi_velocities_ = false;
  bool has_user_joints_ = false;
};

template <int Level>
std::unique_ptr<OpenSweeps> sweeps_at(const LinkTree& tree, const Limbs* limbs) {
  return std::make_unique<OpenSweepsAt<LinkTree, Spatial, Level>>(tree, limbs);
}
template <int Level>
std::unique_ptr<OpenSweeps> sweeps_at(const PlanarTree& tree) {
  return std::make_unique<OpenSweepsAt<PlanarTree, Planar, Level>>(tree, nullptr);
}

}  // namespace momenta
