#pragma once
// LoopedSweeps at one level; included by the files that are compiled for it, and nowhere else, as
// core/kernel/levels/open_sweeps_at.h says why.

#include <momenta/core/kernel/levels/strided.h>
#include <momenta/dae/sweeps/branches/looped_branches.h>
#include <momenta/dae/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <class Tree, class Space, int Level, int Rows>
class LoopedSweepsAt final : public LoopedSweeps {
  using One = Pack<1, Level>;
  /// States side by side: one by one in the widest fronts, which fill the registers by themselves.
  using Many = Pack<(Rows > 8 ? 1 : native_width<Level>), Level>;
  static constexpr std::size_t abreast = Rows > 8 ? 1 : native_width<Level>;

 public:
  LoopedSweepsAt(const Tree& tree, const SweptLoops<Space>& swept,
                 LoopedBranchGroups looped_branches)
      : tree_(tree),
        loops_(swept.loops),
        plan_(swept.plan),
        shared_(swept.shared),
        looped_branches_(std::move(looped_branches)),
        momentum_(swept_by<LoopSweeps<Space, One, Rows, true>>()) {}

  bool momentum(double t, const double* q, const double* p, const RightSide<double>& right,
                double* u, double* sigma, double* pdot) override {
    const bool ok = momentum_(One(t), StridedIn<One>{q, 1}, StridedIn<One>{p, 1},
                              StridedIn<One>{p, 1}, one(right), StridedOut<One>{u, 1},
                              StridedOut<One>{sigma, 1}, StridedOut<One>{pdot, 1});
    if (!shared_.empty()) shared_.to_given(sigma, 1);
    singular_joint_ = momentum_.singular_joint();
    weak_looped_branch_ = momentum_.weak_looped_branch();
    return ok;
  }
  bool acceleration(double t, const double* q, const double* u, const double* tau,
                    const RightSide<double>& right, double* udot, double* lambda) override {
    auto& sweeps = made(acceleration_);
    const bool ok = sweeps(One(t), StridedIn<One>{q, 1}, StridedIn<One>{u, 1},
                           StridedIn<One>{tau, 1}, one(right), StridedOut<One>{udot, 1},
                           StridedOut<One>{lambda, 1}, StridedOut<One>{udot, 1});
    if (!shared_.empty()) shared_.to_given(lambda, 1);
    singular_joint_ = sweeps.singular_joint();
    weak_looped_branch_ = sweeps.weak_looped_branch();
    return ok;
  }
  bool momentum(double t, const LoopedStates& s, double fade, double leak) override {
    if (decltype(many_)::element_type::bytes(tree_, loops_) > most_bytes)
      return one_by_one(t, s, fade, leak);
    auto& sweeps = made(many_);
    RightSide<Many> right;
    right.fade = fade;
    right.leak = leak;
    right.rates = true;
    constexpr std::size_t slots = abreast;
    bool all = true;
    weak_looped_branch_ = false;
    const auto pack = [&](const double* q, const double* p, double* u, double* sigma, double* pdot,
                          std::ptrdiff_t stride) {
      const StridedIn<Many> x{p, stride};
      all &= sweeps(Many(t), StridedIn<Many>{q, stride}, x, x, right, StridedOut<Many>{u, stride},
                    StridedOut<Many>{sigma, stride}, StridedOut<Many>{pdot, stride});
      if (!all) singular_joint_ = sweeps.singular_joint();
      weak_looped_branch_ |= sweeps.weak_looped_branch();
    };
    std::size_t first = 0;
    for (; first + slots <= s.count; first += slots)
      pack(s.q + first, s.p + first, s.u + first, s.sigma + first, s.pdot + first, s.stride);
    if (first < s.count) rest(s, first, pack);
    to_given(s);
    return all;
  }

  std::size_t faded_rows(int* rows, bool of_momentum) const override {
    std::size_t count = 0;
    each_pivot(of_momentum, [&](int row, double w, double tau) {
      if (has_faded(w, tau)) rows[count++] = row;
    });
    return count;
  }
  Pivots pivots(bool of_momentum) const override {
    Pivots p;
    each_pivot(of_momentum, [&](int, double w, double tau) {
      if (has_faded(w, tau))
        ++p.faded;
      else if (w < p.weakest * tau)
        p.weakest = w / tau;
    });
    return p;
  }
  int slots() const override { return Rows; }
  int width() const override { return static_cast<int>(abreast); }
  int singular_joint() const override { return singular_joint_; }
  bool weak_looped_branch() const override { return weak_looped_branch_; }

 private:
  RightSide<One> one(const RightSide<double>& right) {
    static_assert(sizeof(One) == sizeof(double));
    const bool paired = right.centre && !shared_.empty();
    const double* centre = paired ? shared_.to_paired(right.centre) : right.centre;
    return right.of_rows(reinterpret_cast<const One*>(centre),
                         reinterpret_cast<const One*>(right.compliance));
  }
  void to_given(const LoopedStates& s) {
    if (shared_.empty()) return;
    for (std::size_t i = 0; i < s.count; ++i) shared_.to_given(s.sigma + i, s.stride);
  }
  template <class Report>
  void each_pivot(bool of_momentum, Report&& report) const {
    if (of_momentum)
      momentum_.each_pivot(report);
    else if (acceleration_)
      acceleration_->each_pivot(report);
  }
  template <class Sweeps>
  Sweeps swept_by() const {
    if constexpr (Space::dimension == 6)
      return Sweeps(tree_, loops_, plan_, &looped_branches_);
    else
      return Sweeps(tree_, loops_, plan_);
  }
  template <class Sweeps>
  Sweeps& made(std::unique_ptr<Sweeps>& sweeps) {
    if (!sweeps) sweeps.reset(new Sweeps(swept_by<Sweeps>()));
    return *sweeps;
  }

  /// Packs whose records leave the cache take longer than the same states one after the other.
  static constexpr std::size_t most_bytes = 16 << 20;
  bool one_by_one(double t, const LoopedStates& s, double fade, double leak) {
    RightSide<One> right;
    right.fade = fade;
    right.leak = leak;
    right.rates = true;
    bool all = true, weak = false;
    for (std::size_t i = 0; i < s.count; ++i) {
      const StridedIn<One> x{s.p + i, s.stride};
      all &= momentum_(One(t), StridedIn<One>{s.q + i, s.stride}, x, x, right,
                       StridedOut<One>{s.u + i, s.stride}, StridedOut<One>{s.sigma + i, s.stride},
                       StridedOut<One>{s.pdot + i, s.stride});
      if (!all) singular_joint_ = momentum_.singular_joint();
      weak |= momentum_.weak_looped_branch();
    }
    weak_looped_branch_ = weak;
    to_given(s);
    return all;
  }

  /// The states that fill no pack, copied into one; its last slots repeat the last state.
  template <class PackOf>
  void rest(const LoopedStates& s, std::size_t first, PackOf&& pack) {
    constexpr std::size_t slots = abreast;
    const auto nq = static_cast<std::size_t>(tree_.model->nq),
               nv = static_cast<std::size_t>(tree_.model->nv),
               m = static_cast<std::size_t>(loops_.rows);
    if (padded_.size() < (nq + 3 * nv + m) * slots) padded_.resize((nq + 3 * nv + m) * slots);
    double *q = &padded_.data()->v, *p = q + nq * slots, *u = p + nv * slots,
           *pdot = u + nv * slots, *sigma = pdot + nv * slots;
    const auto at = [&](std::size_t i, std::size_t state) {
      return static_cast<std::ptrdiff_t>(i) * s.stride + static_cast<std::ptrdiff_t>(state);
    };
    const std::size_t count = s.count - first;
    for (std::size_t slot = 0; slot < slots; ++slot) {
      const std::size_t state = first + (slot < count ? slot : count - 1);
      for (std::size_t i = 0; i < nq; ++i) q[i * slots + slot] = s.q[at(i, state)];
      for (std::size_t i = 0; i < nv; ++i) p[i * slots + slot] = s.p[at(i, state)];
    }
    pack(q, p, u, sigma, pdot, static_cast<std::ptrdiff_t>(slots));
    for (std::size_t slot = 0; slot < count; ++slot) {
      for (std::size_t i = 0; i < nv; ++i) {
        s.u[at(i, first + slot)] = u[i * slots + slot];
        s.pdot[at(i, first + slot)] = pdot[i * slots + slot];
      }
      for (std::size_t i = 0; i < m; ++i) s.sigma[at(i, first + slot)] = sigma[i * slots + slot];
    }
  }

  const Tree& tree_;
  const LoopModel<Space>& loops_;
  const LoopPlan& plan_;
  SharedPoints shared_;
  LoopedBranchGroups looped_branches_;
  LoopSweeps<Space, One, Rows, true> momentum_;
  std::unique_ptr<LoopSweeps<Space, One, Rows, false>> acceleration_;
  std::unique_ptr<LoopSweeps<Space, Many, Rows, true>> many_;
  std::vector<One> padded_;
  int singular_joint_ = -1;
  bool weak_looped_branch_ = false;
};

/// The narrowest fronts that hold the plan's slots.
template <int Level, class Space, class Tree>
std::unique_ptr<LoopedSweeps> looped_sweeps_at(const Tree& tree, const SweptLoops<Space>& swept,
                                               LoopedBranchGroups looped_branches) {
  const LoopPlan& plan = swept.plan;
  const auto make = [&]<int Rows>() -> std::unique_ptr<LoopedSweeps> {
    return std::make_unique<LoopedSweepsAt<Tree, Space, Level, Rows>>(tree, swept,
                                                                      std::move(looped_branches));
  };
  if constexpr (Space::dimension == 3)
    if (plan.slots <= 2) return make.template operator()<2>();
  if (plan.slots <= 4) return make.template operator()<4>();
  if (plan.slots <= 8) return make.template operator()<8>();
  return make.template operator()<16>();
}

}  // namespace momenta
