#include "equations/quad_loops.h"

#include <momenta/core/expression/functions_quad.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {
namespace {

struct In {
  const double* x;
  Quad operator[](int i) const { return Quad(x[i]); }
};
struct Out {
  Quad* x;
  Quad& operator[](int i) const { return x[i]; }
};

template <class Space, class Tree>
LoopedRates rates_in(const Mechanism& mechanism, const Model<Space>& model, const Tree& tree,
                     const Eigen::VectorXd& q, const Eigen::VectorXd& p, const Eigen::VectorXd& v,
                     double leak, double fade) {
  const LoopModel<Space> loops =
      in_link_frames(build_loops(mechanism.scene(), mechanism.tree(), model), tree);
  const LoopPlan plan = plan_loops(model, loops);
  const auto nv = static_cast<std::size_t>(mechanism.nv());
  std::vector<Quad> u(nv), pdot(nv), udot(nv), sigma(static_cast<std::size_t>(mechanism.m()));
  const std::vector<double> zero(nv);
  RightSide<Quad> right;
  right.leak = leak;
  right.fade = fade;
  right.rates = true;
  constexpr int slots = LoopPlan::most_slots;
  LoopSweeps<Space, Quad, slots, true> momentum(tree, loops, plan);
  momentum(Quad(0.0), In{q.data()}, In{p.data()}, In{p.data()}, right, Out{u.data()},
           Out{sigma.data()}, Out{pdot.data()});
  LoopSweeps<Space, Quad, slots, false> acceleration(tree, loops, plan);
  acceleration(Quad(0.0), In{q.data()}, In{v.data()}, In{zero.data()}, right, Out{udot.data()},
               Out{sigma.data()}, Out{udot.data()});
  const auto rounded = [](const std::vector<Quad>& x) {
    Eigen::VectorXd r(static_cast<Eigen::Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) r[static_cast<Eigen::Index>(i)] = value_of(x[i]);
    return r;
  };
  return {rounded(u), rounded(pdot), rounded(udot)};
}

}  // namespace

LoopedRates quad_rates(const Mechanism& mechanism, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& p, const Eigen::VectorXd& v, double leak,
                       double fade) {
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar) {
    const auto model = build_planar_model(tree, mechanism.scene(), mechanism.plan().basis);
    return rates_in<Planar>(mechanism, model, build_links(model), q, p, v, leak, fade);
  }
  const auto model = build_spatial_model(tree, mechanism.scene());
  return rates_in<Spatial>(mechanism, model, build_links(model), q, p, v, leak, fade);
}

}  // namespace momenta
