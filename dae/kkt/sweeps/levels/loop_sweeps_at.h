#pragma once
// LoopedSweeps at one level; included by the files that are compiled for it, and nowhere else, as
// core/kernel/levels/open_sweeps_at.h says why.

#include <momenta/core/kernel/levels/joint_forces.h>
#include <momenta/core/kernel/levels/strided.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <class Tree, class Space, int Level, int Rows>
class LoopedSweepsAt final : public LoopedSweeps {
  using One = Pack<1, Level>;
  using In = CoordinatesIn<One>;
  using Out = CoordinatesOut<One>;
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
        carried_(swept.carried),
        looped_branches_(std::move(looped_branches)),
        momentum_(swept_by<LoopSweeps<Space, One, Rows, true>>()) {}

  bool momentum(double t, const double* q, const double* p, const RightSide<double>& right,
                double* u, double* sigma, double* pdot) override {
    const bool ok =
        momentum_(One(t), In{q}, In{p}, In{p}, one(right), Out{u}, Out{sigma}, Out{pdot});
    to_given(sigma, 1, right.centre);
    singular_joint_ = momentum_.singular_joint();
    weak_looped_branch_ = momentum_.weak_looped_branch();
    return ok;
  }
  bool acceleration(double t, const double* q, const double* u, const double* tau,
                    const RightSide<double>& right, double* udot, double* lambda) override {
    auto& sweeps = made(acceleration_);
    const bool ok =
        sweeps(One(t), In{q}, In{u}, In{tau}, one(right), Out{udot}, Out{lambda}, Out{udot});
    to_given(lambda, 1, right.centre);
    singular_joint_ = sweeps.singular_joint();
    weak_looped_branch_ = sweeps.weak_looped_branch();
    return ok;
  }
  bool momentum(double t, const LoopedStates& s, double fade, double leak) override {
    return each_pack(t, s, momenta_of_many_, momentum_, fade, leak);
  }
  bool acceleration(double t, const LoopedStates& s, double fade) override {
    return each_pack(t, s, accelerations_of_many_, made(acceleration_), fade, 0);
  }

  std::size_t faded_rows(int* rows, bool of_momentum) const override {
    std::size_t count = 0;
    each_pivot(of_momentum, [&](int row, double w, double tau) {
      if (has_faded(w, tau)) rows[count++] = carried_.given(row);
    });
    for (const int row : carried_.left_out()) rows[count++] = row;
    return count;
  }
  Pivots pivots(bool of_momentum) const override {
    Pivots p;
    p.faded = static_cast<int>(carried_.left_out().size());
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
    const double *centre = right.centre, *compliance = right.compliance;
    if (centre && !shared_.empty()) centre = shared_.to_paired(centre);
    if (centre && !carried_.all()) centre = carried_.to_carried(centre);
    if (compliance && !carried_.all()) compliance = carried_.of_carried(compliance);
    return right.of_rows(reinterpret_cast<const One*>(centre),
                         reinterpret_cast<const One*>(compliance));
  }
  /// Turns multipliers of swept rows into those of Φ, in place.
  void to_given(double* sigma, std::ptrdiff_t stride, const double* centre) {
    if (!shared_.empty()) shared_.to_given(sigma, stride);
    if (!carried_.all()) carried_.to_given(sigma, stride, centre);
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
  /// Sweeps states in packs by `many`, made at first use, or one by one.
  template <class OfMany, class OfOne>
  bool each_pack(double t, const LoopedStates& s, std::unique_ptr<OfMany>& many, OfOne& one,
                 double fade, double leak) {
    weak_looped_branch_ = false;
    bool all = true;
    if (abreast == 1 || OfMany::bytes(tree_, loops_) > most_bytes) {
      for (std::size_t i = 0; i < s.count; ++i)
        padded<1>(s.part(i, 1),
                  [&](const LoopedStates& state) { all &= taken<One>(one, t, state, fade, leak); });
    } else if constexpr (abreast > 1) {
      constexpr std::size_t width = abreast;
      OfMany& sweeps = made(many);
      std::size_t first = 0;
      for (; first + width <= s.count; first += width)
        all &= taken<Many>(sweeps, t, s.part(first, width), fade, leak);
      if (first < s.count)
        padded<width>(s.part(first, s.count - first), [&](const LoopedStates& rest) {
          all &= taken<Many>(sweeps, t, rest, fade, leak);
        });
    }
    if (!shared_.empty() || !carried_.all())
      for (std::size_t i = 0; i < s.count; ++i) to_given(s.sigma + i, s.stride, nullptr);
    return all;
  }
  /// Sweeps one pack.
  template <class X, class Sweeps>
  bool taken(Sweeps& sweeps, double t, const LoopedStates& s, double fade, double leak) {
    RightSide<X> right;
    right.fade = fade;
    right.leak = leak;
    right.rates = Sweeps::of_momenta;
    right.body_forces = s.body_forces;
    const StridedIn<X> q{s.q, s.stride}, x{s.p, s.stride};
    StridedIn<X> tau = x;
    if constexpr (!Sweeps::of_momenta) {
      forces_.resize((static_cast<std::size_t>(tree_.model->nv) + 1) * abreast);
      tau = joint_forces(*tree_.model, s.tau, s.stride, q, x, &forces_.data()->v);
    }
    double* const rates = Sweeps::of_momenta ? s.pdot : s.u;
    bool ok;
    if constexpr (std::is_same_v<X, One>)
      ok = sweeps(X(t), In{q.base}, In{x.base}, In{tau.base}, right, Out{s.u}, Out{s.sigma},
                  Out{rates});
    else
      ok = sweeps(X(t), q, x, tau, right, StridedOut<X>{s.u, s.stride},
                  StridedOut<X>{s.sigma, s.stride}, StridedOut<X>{rates, s.stride});
    if (!ok) singular_joint_ = sweeps.singular_joint();
    weak_looped_branch_ |= sweeps.weak_looped_branch();
    return ok;
  }
  /// Calls act on states that fill no pack, copied into one; its last slots repeat the last state.
  template <std::size_t width, class Act>
  void padded(const LoopedStates& s, Act&& act) {
    const auto nq = static_cast<std::size_t>(tree_.model->nq),
               nv = static_cast<std::size_t>(tree_.model->nv),
               m = static_cast<std::size_t>(loops_.rows);
    if (padded_.size() < (nq + 4 * nv + m) * width) padded_.resize((nq + 4 * nv + m) * width);
    double *q = &padded_.data()->v, *p = q + nq * width, *u = p + nv * width,
           *pdot = u + nv * width, *tau = pdot + nv * width, *sigma = tau + nv * width;
    const auto at = [&](std::size_t i, std::size_t state) {
      return static_cast<std::ptrdiff_t>(i) * s.stride + static_cast<std::ptrdiff_t>(state);
    };
    for (std::size_t slot = 0; slot < width; ++slot) {
      const std::size_t state = slot < s.count ? slot : s.count - 1;
      for (std::size_t i = 0; i < nq; ++i) q[i * width + slot] = s.q[at(i, state)];
      for (std::size_t i = 0; i < nv; ++i) p[i * width + slot] = s.p[at(i, state)];
      for (std::size_t i = 0; s.tau && i < nv; ++i) tau[i * width + slot] = s.tau[at(i, state)];
    }
    act(LoopedStates{q, p, u, sigma, pdot, static_cast<std::ptrdiff_t>(width), width,
                     s.tau ? tau : nullptr, s.body_forces});
    for (std::size_t slot = 0; slot < s.count; ++slot) {
      for (std::size_t i = 0; i < nv; ++i) {
        s.u[at(i, slot)] = u[i * width + slot];
        if (s.pdot) s.pdot[at(i, slot)] = pdot[i * width + slot];
      }
      for (std::size_t i = 0; i < m; ++i) s.sigma[at(i, slot)] = sigma[i * width + slot];
    }
  }

  const Tree& tree_;
  const LoopModel<Space>& loops_;
  const LoopPlan& plan_;
  SharedPoints shared_;
  CarriedRows carried_;
  LoopedBranchGroups looped_branches_;
  LoopSweeps<Space, One, Rows, true> momentum_;
  std::unique_ptr<LoopSweeps<Space, One, Rows, false>> acceleration_;
  std::unique_ptr<LoopSweeps<Space, Many, Rows, true>> momenta_of_many_;
  std::unique_ptr<LoopSweeps<Space, Many, Rows, false>> accelerations_of_many_;
  std::vector<One> padded_, forces_;
  int singular_joint_ = -1;
  bool weak_looped_branch_ = false;
};

/// The narrowest fronts that hold the plan's slots.
template <int Level, class Space, class Tree>
std::unique_ptr<LoopedSweeps> looped_sweeps_at(const Tree& tree, const SweptLoops<Space>& swept,
                                               LoopedBranchGroups looped_branches) {
  constexpr bool planar = Space::dimension == 3;
  const int lanes = lanes_for(swept.plan.slots, planar);
  const auto make = [&]<int Rows>() -> std::unique_ptr<LoopedSweeps> {
    return std::make_unique<LoopedSweepsAt<Tree, Space, Level, Rows>>(tree, swept,
                                                                      std::move(looped_branches));
  };
  if constexpr (planar)
    if (lanes == 2) return make.template operator()<2>();
  if (lanes == 4) return make.template operator()<4>();
  if (lanes == 8) return make.template operator()<8>();
  return make.template operator()<16>();
}

}  // namespace momenta
