#pragma once
// TangentSweeps and KineticSweep at one level; included by the files that are
// compiled for it, and nowhere else, as core/kernel/levels/open_sweeps_at.h says why.

#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/gradient/levels/direction_slots.h>
#include <momenta/dae/gradient/levels/number_sweep_at.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

#include <vector>

namespace momenta {

/// x + δx ε of plain arrays.
template <int L>
struct DirectionsIn {
  const double *x, *dx;
  MOMENTA_INLINE Directions<1, L> operator[](int i) const {
    Directions<1, L> s;
    s.a = Pack<1, L>(x[i]);
    s.b[0] = Pack<1, L>(dx[i]);
    return s;
  }
};
template <int L>
struct DirectionsOut {
  Directions<1, L>* x;
  MOMENTA_INLINE Directions<1, L>& operator[](int i) const { return x[i]; }
};

template <class Tree, class Space, int Level, int Rows>
class TangentSweepsAt final : public TangentSweeps {
  using S = Directions<1, Level>;

 public:
  TangentSweepsAt(const Tree& tree, const SweptLoops<Space>& swept, double fade, bool body_forces)
      : sweeps_(tree, swept.loops, swept.plan),
        nv_(tree.model->nv),
        m_(swept.loops.rows),
        numbers_(static_cast<std::size_t>(2 * nv_ + m_)),
        besides_(static_cast<std::size_t>(m_)) {
    right_.fade = fade;
    right_.rates = true;
    right_.body_forces = body_forces;
  }

  void feed_back(double leak, double beta) override {
    right_.leak = leak;
    right_.positions = beta;
  }
  bool operator()(double t, const double* q, const double* p, const double* dq, const double* dp,
                  const Result& to, const double* besides) override {
    sweeps_.add_to_rows(besides ? besides_.data() : nullptr);
    for (int i = 0; besides && i < m_; ++i)
      besides_[static_cast<std::size_t>(i)].b[0] = Pack<1, Level>(besides[i]);
    S *const u = numbers_.data(), *const pdot = u + nv_, *const sigma = pdot + nv_;
    const DirectionsIn<Level> momenta{p, dp};
    if (!sweeps_(S(t), DirectionsIn<Level>{q, dq}, momenta, momenta, right_,
                 DirectionsOut<Level>{u}, DirectionsOut<Level>{sigma},
                 DirectionsOut<Level>{pdot}) ||
        sweeps_.weak_looped_branch())
      return false;
    for (int i = 0; i < nv_; ++i) {
      to.u[i] = u[i].a.v;
      to.du[i] = u[i].b[0].v;
      to.dpdot[i] = pdot[i].b[0].v;
    }
    for (int i = 0; i < m_; ++i) {
      to.sigma[i] = sigma[i].a.v;
      to.dsigma[i] = sigma[i].b[0].v;
    }
    return true;
  }

 private:
  LoopSweeps<Space, S, Rows, true> sweeps_;
  RightSide<S> right_;
  int nv_, m_;
  std::vector<S> numbers_;  ///< u, ṗ, σ
  std::vector<S> besides_;  ///< added to the second row
};

template <class Space, int Level>
class KineticSweepAt final : public KineticSweep {
 public:
  explicit KineticSweepAt(const Model<Space>& model)
      : model_(model), place_(model), p_(place_.q.size()) {}

  void along(double t, const double* q, const double* u, const double* v, double* rates,
             double* momenta) override {
    for (std::size_t i = 0; i < p_.size(); ++i) {
      place_.q[i] = place_.along(One(q[i]), One(0.0));
      place_.u[i] = place_.along(One(u[i]), One(v[i]));
    }
    place_.place(One(t), false);
    auto& w = place_.w;
    body_momenta(w);
    momenta_inward(w, p_.data());
    for (std::size_t i = 0; i < p_.size(); ++i) momenta[i] = p_[i].b[0].v;
    for (auto& body : w.body) body.T = {};
    momentum_rates_inward(w, place_.q.data(), place_.u.data(), p_.data());
    for (const auto& b : model_.bodies)
      if (b.nv == 1) {
        const auto at = static_cast<std::size_t>(b.u);
        p_[at] -= joint_force(b, place_.q[static_cast<std::size_t>(b.q)], place_.u[at]);
      }
    for (std::size_t i = 0; i < p_.size(); ++i) rates[i] = p_[i].b[0].v;
  }

 private:
  using One = Pack<1, Level>;
  const Model<Space>& model_;
  PlacedAlong<Space, Level, 1> place_;
  std::vector<Directions<1, Level>> p_;
};

/// Sweeps with the narrowest fronts that hold the plan's slots.
template <int Level, class Space, class Tree>
std::unique_ptr<TangentSweeps> tangent_sweeps_at(const Tree& tree, const SweptLoops<Space>& swept,
                                                 double fade, bool body_forces) {
  constexpr bool planar = Space::dimension == 3;
  const int lanes = lanes_for(swept.plan.slots, planar);
  const auto make = [&]<int Rows>() -> std::unique_ptr<TangentSweeps> {
    return std::make_unique<TangentSweepsAt<Tree, Space, Level, Rows>>(tree, swept, fade,
                                                                       body_forces);
  };
  if constexpr (planar)
    if (lanes == 2) return make.template operator()<2>();
  if (lanes == 4) return make.template operator()<4>();
  if (lanes == 8) return make.template operator()<8>();
  return make.template operator()<16>();
}
template <int Level, class Space>
std::unique_ptr<KineticSweep> kinetic_sweep_at(const Model<Space>& model) {
  return std::make_unique<KineticSweepAt<Space, Level>>(model);
}

}  // namespace momenta
