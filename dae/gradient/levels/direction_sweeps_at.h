#pragma once
// DirectionSweeps at one level; included by the files that are compiled for it, and nowhere else,
// as core/kernel/levels/open_sweeps_at.h says why.

#include <momenta/dae/gradient/levels/direction_sweeps.h>
#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

#include <vector>

namespace momenta {

// Values are alike in all lanes: a choice holds for all directions.
template <int W, int L>
MOMENTA_INLINE Directions<W, L> where_greater(const Directions<W, L>& a, const Directions<W, L>& b,
                                              const Directions<W, L>& x,
                                              const Directions<W, L>& y) {
  Directions<W, L> chosen;
  chosen.a = where_greater(a.a, b.a, x.a, y.a);
  chosen.b[0] = where_greater(a.a, b.a, x.b[0], y.b[0]);
  return chosen;
}
template <int W, int L>
MOMENTA_INLINE double size_of(const Directions<W, L>& x) {
  const double size = x.a.lane(0);
  return size > 0 ? size : 0;
}

/// x + Σ δx_k ε_k of plain arrays.
template <int W, int L>
struct LanesIn {
  const double *x, *dx;
  MOMENTA_INLINE Directions<W, L> operator[](int i) const {
    Directions<W, L> s;
    s.a = Pack<W, L>(x[i]);
    s.b[0] = Pack<W, L>::load(dx + W * i);
    return s;
  }
};
/// Results, read back while they are made.
template <int W, int L>
struct LanesOut {
  Directions<W, L>* x;
  MOMENTA_INLINE Directions<W, L>& operator[](int i) const { return x[i]; }
};

template <class Tree, class Space, int Level, int Rows>
class DirectionSweepsAt final : public DirectionSweeps {
  static constexpr int lanes = native_width<Level>;
  using S = Directions<lanes, Level>;
  using In = LanesIn<lanes, Level>;
  using Out = LanesOut<lanes, Level>;

 public:
  DirectionSweepsAt(const Tree& tree, const SweptLoops<Space>& swept, double fade, bool body_forces)
      : sweeps_(tree, swept.loops, swept.plan),
        nv_(tree.model->nv),
        m_(swept.loops.rows),
        numbers_(static_cast<std::size_t>(2 * nv_ + m_)),
        besides_(static_cast<std::size_t>(m_)) {
    right_.fade = fade;
    right_.rates = true;
    right_.body_forces = body_forces;
  }

  int width() const override { return lanes; }
  void feed_back(double leak, double beta) override {
    right_.leak = leak;
    right_.positions = beta;
  }
  bool operator()(double t, const double* q, const double* p, const double* dq, const double* dp,
                  const double* besides, const Result& to) override {
    sweeps_.add_to_rows(besides ? besides_.data() : nullptr);
    for (int i = 0; besides && i < m_; ++i) {
      S& d = besides_[static_cast<std::size_t>(i)];
      d.a = Pack<lanes, Level>(0.0);
      d.b[0] = Pack<lanes, Level>::load(besides + lanes * i);
    }
    S *const u = numbers_.data(), *const pdot = u + nv_, *const sigma = pdot + nv_;
    const In momenta{p, dp};
    if (!sweeps_(S(t), In{q, dq}, momenta, momenta, right_, Out{u}, Out{sigma}, Out{pdot}) ||
        sweeps_.weak_looped_branch())
      return false;
    const auto store = [](const S* x, int count, double* at) {
      for (int i = 0; i < count; ++i) x[i].b[0].store(at + lanes * i);
    };
    store(u, nv_, to.du);
    store(pdot, nv_, to.dpdot);
    store(sigma, m_, to.dsigma);
    return true;
  }

 private:
  LoopSweeps<Space, S, Rows, true> sweeps_;
  RightSide<S> right_;
  int nv_, m_;
  std::vector<S> numbers_;  ///< u, ṗ, σ
  std::vector<S> besides_;  ///< added to the second row
};

/// Two widths of fronts for all plans: each width has its own groups of slots.
template <int Level, class Space, class Tree>
std::unique_ptr<DirectionSweeps> direction_sweeps_at(const Tree& tree,
                                                     const SweptLoops<Space>& swept, double fade,
                                                     bool body_forces) {
  const int slots = swept.plan.slots;
  if (slots <= 4)
    return std::make_unique<DirectionSweepsAt<Tree, Space, Level, 4>>(tree, swept, fade,
                                                                      body_forces);
  if (slots <= 8)
    return std::make_unique<DirectionSweepsAt<Tree, Space, Level, 8>>(tree, swept, fade,
                                                                      body_forces);
  return nullptr;
}

}  // namespace momenta
