#pragma once
// BatchSweeps at one level; included only by files compiled for it: open_sweeps_at.h.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/kernel/levels/batch_sweeps.h>
#include <momenta/core/kernel/levels/joint_forces.h>
#include <momenta/core/kernel/levels/lazy.h>
#include <momenta/core/kernel/levels/strided.h>
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
    return each_pack(s, [&](const States& pack) {
      const std::ptrdiff_t stride = pack.stride;
      const bool direct = !quasi_velocities_;  // q̇ = u
      if (!direct) rates_.resize(static_cast<std::size_t>(tree_.model->nv) * lanes);
      const StridedOut<Many> u{direct ? pack.qdot : rates_.data(), direct ? stride : lanes};
      if (!momenta_.get(tree_)(Many(t), StridedIn<Many>{pack.q, stride},
                               StridedIn<Many>{pack.p, stride}, u,
                               StridedOut<Many>{pack.pdot, stride})) {
        joint_ = momenta_.get(tree_).singular_joint();
        return false;
      }
      if (!direct) coordinate_rates(pack.q, pack.qdot, stride);
      return finite(pack.qdot, tree_.model->nq, stride) &&
             finite(pack.pdot, tree_.model->nv, stride);
    });
  }
  bool acceleration(double t, const States& s) override {
    return each_pack(s, [&](const States& pack) {
      const std::ptrdiff_t stride = pack.stride;
      const StridedIn<Many> q{pack.q, stride}, u{pack.p, stride};
      forces_.resize((static_cast<std::size_t>(tree_.model->nv) + 1) * lanes);
      const bool ok = accelerations_.get(tree_)(
          Many(t), q, u, joint_forces(*tree_.model, pack.tau, stride, q, u, forces_.data()),
          StridedOut<Many>{pack.pdot, stride});
      if (!ok) joint_ = accelerations_.get(tree_).singular_joint();
      return ok && finite(pack.pdot, tree_.model->nv, stride);
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
  /// Whether all numbers in these rows of a pack are finite: 0 x is NaN for any other.
  bool finite(const double* x, int rows, std::ptrdiff_t stride) {
    Many sum(1.0);
    for (int i = 0; i < rows; ++i) sum += Many::load(x + i * stride) * Many(0.0);
    const bool all = all_positive(sum);
    if (!all) joint_ = -1;
    return all;
  }

  // Not inlined: g++ 12 warns of stores that are not made.
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

  /// Calls f on every full pack, in place or in a copied block, and on the rest in a padded copy. A
  /// pack that fails is repeated state by state: one bad state spoils no other.
  template <class F>
  bool each_pack(const States& s, F&& f) {
    bool all = true;
    std::size_t first = 0;
    const auto take = [&](const States& part) {
      if (!(part.count == lanes ? f(part) : copied(part, f)))
        all &= one_by_one(part, first, f, all);
      first += part.count;
    };
    if (far_apart(s))
      for (; first + lanes <= s.count;) {
        const std::size_t full = (s.count - first) / lanes * lanes,
                          count = full < most_in_block ? full : most_in_block;
        in_block(s.part(first, count), take);
      }
    while (first < s.count) take(s.part(first, s.count - first < lanes ? s.count - first : lanes));
    return all;
  }

  /// Whether packs in place would touch single lines in more memory than is near: each row of a
  /// large batch starts a page. Shorter rows share pages wanted next, and a copy would take longer.
  bool far_apart(const States& s) const {
    constexpr std::ptrdiff_t near_by = 3 << 19, page = 4096;  // bytes
    return s.stride * 8 >= page &&
           s.stride * (2 * tree_.model->nq + 2 * tree_.model->nv) * 8 > near_by;
  }
  static constexpr std::size_t most_in_block = 64;
  /// Copies rows of packs, `to_next` apart, from `from` or to `to`. Not inlined: as
  /// coordinate_rates().
  [[gnu::noinline]] static void copy_rows(std::size_t count, std::size_t packs,
                                          std::ptrdiff_t stride, double* block, std::size_t to_next,
                                          const double* from, double* to) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < packs; ++k) {
        double* const here = block + k * to_next + i * lanes;
        const std::ptrdiff_t there =
            static_cast<std::ptrdiff_t>(i) * stride + static_cast<std::ptrdiff_t>(k * lanes);
        if (from)
          Many::load(from + there).store(here);
        else
          Many::load(here).store(to + there);
      }
  }
  /// Calls take on a block of full packs, each copied: rows are read and written in the order of
  /// memory.
  template <class Take>
  void in_block(const States& s, Take&& take) {
    const auto nq = static_cast<std::size_t>(tree_.model->nq);
    const auto nv = static_cast<std::size_t>(tree_.model->nv);
    const std::size_t packs = s.count / lanes, rows = 2 * nq + 3 * nv;
    block_.resize(packs * rows * lanes);
    // In every pack: q, p, q̇, ṗ, τ.
    const auto rows_of = [&](std::size_t at, std::size_t count, const double* from, double* to) {
      copy_rows(count, packs, s.stride, block_.data() + at * lanes, rows * lanes, from, to);
    };
    rows_of(0, nq, s.q, nullptr);
    rows_of(nq, nv, s.p, nullptr);
    if (s.tau) rows_of(2 * nq + 2 * nv, nv, s.tau, nullptr);
    for (std::size_t k = 0; k < packs; ++k) {
      double* const q = block_.data() + k * rows * lanes;
      double *const p = q + nq * lanes, *const qdot = p + nv * lanes,
                    *const pdot = qdot + nq * lanes, *const tau = pdot + nv * lanes;
      take(States{q, p, s.qdot ? qdot : nullptr, pdot, lanes, lanes, s.tau ? tau : nullptr});
    }
    if (s.qdot) rows_of(nq + nv, nq, nullptr, s.qdot);
    rows_of(2 * nq + nv, nv, nullptr, s.pdot);
  }

  /// Calls f on the states copied into one pack, the last repeated.
  template <class F>
  bool copied(const States& s, F&& f) {
    const auto nq = static_cast<std::size_t>(tree_.model->nq);
    const auto nv = static_cast<std::size_t>(tree_.model->nv);
    padded_.resize((2 * nq + 3 * nv) * lanes);
    double* const q = padded_.data();
    double* const p = q + nq * lanes;
    double* const qdot = p + nv * lanes;
    double* const pdot = qdot + nq * lanes;
    double* const tau = pdot + nv * lanes;
    const auto at = [&](std::size_t i, std::size_t state) {
      return static_cast<std::ptrdiff_t>(i) * s.stride + static_cast<std::ptrdiff_t>(state);
    };
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t state = lane < s.count ? lane : s.count - 1;
      for (std::size_t i = 0; i < nq; ++i) q[i * lanes + lane] = s.q[at(i, state)];
      for (std::size_t i = 0; i < nv; ++i) p[i * lanes + lane] = s.p[at(i, state)];
      for (std::size_t i = 0; s.tau && i < nv; ++i) tau[i * lanes + lane] = s.tau[at(i, state)];
    }
    if (!f(States{q, p, qdot, pdot, lanes, lanes, s.tau ? tau : nullptr})) return false;
    for (std::size_t lane = 0; lane < s.count; ++lane) {
      for (std::size_t i = 0; s.qdot && i < nq; ++i) s.qdot[at(i, lane)] = qdot[i * lanes + lane];
      for (std::size_t i = 0; i < nv; ++i) s.pdot[at(i, lane)] = pdot[i * lanes + lane];
    }
    return true;
  }
  /// @post failed_state() is the first that failed, if `none_failed_yet`
  template <class F>
  bool one_by_one(const States& s, std::size_t first, F&& f, bool none_failed_yet) {
    bool all = true;
    for (std::size_t i = 0; i < s.count; ++i) {
      const States one = s.part(i, 1);
      if (copied(one, f)) continue;
      if (none_failed_yet && all) {
        failed_state_ = first + i;
        singular_joint_ = joint_;
      }
      all = false;
      const double nothing = __builtin_nan("");
      for (int k = 0; s.qdot && k < tree_.model->nq; ++k) one.qdot[k * s.stride] = nothing;
      for (int k = 0; k < tree_.model->nv; ++k) one.pdot[k * s.stride] = nothing;
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
  Lazy<MomentumSweeps<Space, Many>> momenta_;
  Lazy<AccelerationSweeps<Space, Many>> accelerations_;
  Lazy<JacobianPass<Space, Many>> jacobian_;
  Buffer rates_, padded_, forces_, block_;
  int singular_joint_ = -1,
      joint_ = -1;  ///< singular_joint_: of the first state that failed; joint_: of the last one
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
