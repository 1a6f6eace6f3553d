#pragma once
// BatchSweeps at one level; included by the files that are compiled for it, and nowhere else, as
// open_sweeps_at.h says why.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/kernel/levels/batch_sweeps.h>
#include <momenta/core/kernel/levels/strided.h>
#include <momenta/core/kernel/levels/when_asked.h>
#include <momenta/core/kernel/momentum_sweeps.h>
#include <momenta/core/kernel/planar_acceleration_sweeps.h>
#include <momenta/core/kernel/planar_momentum_sweeps.h>

namespace momenta {

template <class Tree, class Space, int Level>
class BatchSweepsAt final : public BatchSweeps {
  static constexpr int lanes = native_width<Level>;
  using One = Pack<1, Level>;
  using Many = Pack<lanes, Level>;

 public:
  explicit BatchSweepsAt(const Tree& tree) : tree_(tree) {
    for (const auto& b : tree.model->bodies) quasi_velocities_ |= b.nq != b.nv;
  }

  bool momentum(double t, const States& s) override {
    return each_pack(s, [&](const double* q, const double* p, double* qdot, double* pdot,
                            std::ptrdiff_t stride) {
      const bool direct = !quasi_velocities_;  // q̇ = u
      if (!direct) rates_.resize(static_cast<std::size_t>(tree_.model->nv) * lanes);
      const StridedOut<Many> u{direct ? qdot : rates_.data(), direct ? stride : lanes};
      if (!momenta_.get(tree_)(Many(t), StridedIn<Many>{q, stride}, StridedIn<Many>{p, stride}, u,
                               StridedOut<Many>{pdot, stride})) {
        joint_ = momenta_.get(tree_).singular_joint();
        return false;
      }
      if (!direct) coordinate_rates(q, qdot, stride);
      return finite(qdot, tree_.model->nq, stride) && finite(pdot, tree_.model->nv, stride);
    });
  }
  bool acceleration(double t, const States& s) override {
    return each_pack(
        s, [&](const double* q, const double* u, double*, double* udot, std::ptrdiff_t stride) {
          const bool ok = accelerations_.get(tree_)(Many(t), StridedIn<Many>{q, stride},
                                                    StridedIn<Many>{u, stride}, Nothing{},
                                                    StridedOut<Many>{udot, stride});
          if (!ok) joint_ = accelerations_.get(tree_).singular_joint();
          return ok && finite(udot, tree_.model->nv, stride);
        });
  }

  bool jacobian(double t, const double* q, const double* p, double* J,
                std::ptrdiff_t stride) override {
    const bool ok = jacobian_.get(tree_)(t, q, p, J, stride);
    if (!ok) singular_joint_ = jacobian_.get(tree_).singular_joint();
    return ok;
  }

  int width() const override { return lanes; }
  int singular_joint() const override { return singular_joint_; }
  std::size_t failed_state() const override { return failed_state_; }

 private:
  struct Nothing {
    MOMENTA_INLINE Many operator[](int) const { return Many(0.0); }
  };

  /// Whether so many rows of a pack are: 0 x is 0 of a finite x and NaN of any other.
  bool finite(const double* x, int rows, std::ptrdiff_t stride) {
    Many sum(1.0);
    for (int i = 0; i < rows; ++i) sum += Many::load(x + i * stride) * Many(0.0);
    const bool all = all_positive(sum);
    if (!all) joint_ = -1;
    return all;
  }

  // A function of its own: inlined everywhere g++ 12 warns of stores that are not made.
  [[gnu::noinline]] void coordinate_rates(const double* q, double* qdot, std::ptrdiff_t stride) {
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
      if (none_failed_yet && all) {
        failed_state_ = state;
        singular_joint_ = joint_;
      }
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
  WhenAsked<MomentumSweeps<Space, Many>> momenta_;
  WhenAsked<AccelerationSweeps<Space, Many>> accelerations_;
  WhenAsked<JacobianPass<Space, Many>> jacobian_;
  Buffer rates_, padded_;
  int singular_joint_ = -1, joint_ = -1;  ///< of the first state that failed, of the last
  std::size_t failed_state_ = 0;
  bool quasi_velocities_ = false;
};

template <int Level>
std::unique_ptr<BatchSweeps> batch_sweeps_at(const LinkTree& tree) {
  return std::make_unique<BatchSweepsAt<LinkTree, Spatial, Level>>(tree);
}
template <int Level>
std::unique_ptr<BatchSweeps> batch_sweeps_at(const PlanarTree& tree) {
  return std::make_unique<BatchSweepsAt<PlanarTree, Planar, Level>>(tree);
}

}  // namespace momenta
