#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/study/quad_lagrangian.h>
#include <momenta/dae/study/quad_motion.h>
#include <momenta/dae/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/sweeps/spatial_loop_sweeps.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace momenta {
namespace {

/// Pivots this far below their scale are those of redundant rows.
constexpr double fade = 1e-20;
/// Newton steps from the 1e-16 of starts to below 1e-32.
constexpr int newton_steps = 2;

struct In {
  const Quad* x;
  const Quad& operator[](int i) const { return x[i]; }
};
struct Out {
  Quad* x;
  Quad& operator[](int i) const { return x[i]; }
};

/// The plan. @throws std::runtime_error where more equations are open than the sweeps have slots
LoopPlan fitting(LoopPlan plan) {
  if (plan.slots > LoopPlan::most_slots)
    throw std::runtime_error("a reference in quadruple precision takes at most " +
                             std::to_string(LoopPlan::most_slots) +
                             " loop equations open at once, found " + std::to_string(plan.slots));
  return plan;
}

template <class Space, class Tree>
class QuadSweeps final : public QuadMotion {
 public:
  QuadSweeps(const Mechanism& mechanism, Model<Space> model)
      : mechanism_(mechanism),
        model_(std::move(model)),
        links_(build_links(model_)),
        loops_(in_link_frames(build_loops(mechanism.scene(), mechanism.tree(), model_), links_)),
        plan_(fitting(plan_loops(model_, loops_))),
        e_(mechanism.evaluation<Quad>()),
        accelerations_(links_, loops_, plan_),
        corrections_(links_, loops_, plan_),
        tau_(static_cast<std::size_t>(mechanism.nv())),
        work_(tau_.size()),
        sigma_(static_cast<std::size_t>(mechanism.m())),
        delta_(static_cast<std::size_t>(mechanism.nq())) {}

  bool rates(double t, const Quad* y, Quad* ydot) override {
    const Quad *q = y, *u = y + mechanism_.nq();
    Quad* udot = ydot + mechanism_.nq();
    e_->applied_forces(t, q, u, tau_.data());
    RightSide<Quad> right;
    right.fade = fade;
    if (!accelerations_(Quad(t), In{q}, In{u}, In{tau_.data()}, right, Out{udot},
                        Out{sigma_.data()}, Out{udot}))
      return false;
    e_->coordinate_rates(q, u, ydot);
    return true;
  }

  const Quad* multipliers() const override { return sigma_.data(); }

  bool project(double t, Quad* y) override {
    Quad *q = y, *u = y + mechanism_.nq();
    normalise(q);
    if (mechanism_.m() == 0) return true;
    RightSide<Quad> right;
    right.fade = fade;
    for (int k = 0; k < newton_steps; ++k) {
      std::fill(tau_.begin(), tau_.end(), Quad(0));
      right.drives = false;
      right.positions = 1;
      if (!solve(t, q, tau_.data(), right, work_.data())) return false;
      e_->place(t, q);
      e_->coordinate_rates(q, work_.data(), delta_.data());
      for (std::size_t i = 0; i < delta_.size(); ++i) q[i] += delta_[i];
    }
    e_->place(t, q);
    e_->move(u);
    e_->momenta(nullptr, tau_.data());
    right.drives = true;
    right.positions = 0;
    return solve(t, q, tau_.data(), right, u);
  }

 private:
  bool solve(double t, const Quad* q, const Quad* p, const RightSide<Quad>& right, Quad* u) {
    return corrections_(Quad(t), In{q}, In{p}, In{p}, right, Out{u}, Out{sigma_.data()}, Out{u});
  }
  void normalise(Quad* q) const {
    for (const auto& b : mechanism_.tree().bodies) {
      if (!b.has_quaternion()) continue;
      Quad* quaternion = q + b.q + (b.nq - 4);
      Quad norm = 0;
      for (int i = 0; i < 4; ++i) norm += quaternion[i] * quaternion[i];
      norm = sqrt(norm);
      for (int i = 0; i < 4; ++i) quaternion[i] /= norm;
    }
  }

  const Mechanism& mechanism_;
  Model<Space> model_;
  Tree links_;
  LoopModel<Space> loops_;
  LoopPlan plan_;
  std::unique_ptr<Evaluation<Quad>> e_;
  LoopSweeps<Space, Quad, LoopPlan::most_slots, false> accelerations_;
  LoopSweeps<Space, Quad, LoopPlan::most_slots, true> corrections_;
  std::vector<Quad> tau_, work_, sigma_, delta_;
};

}  // namespace

std::unique_ptr<QuadMotion> make_quad_motion(const Mechanism& mechanism) {
  refuse_bearings(mechanism.scene(), "integration in quadruple precision");
  if (mechanism.scene().lagrangian) return make_quad_lagrangian(mechanism);
  const Tree& tree = mechanism.tree();
  for (const auto& b : tree.bodies)
    if (b.law)
      throw std::runtime_error("joint '" + b.joint +
                               "' is a user joint, whose formula has no values in quadruple "
                               "precision; expected a reference from a file");
  if (mechanism.plan().planar)
    return std::make_unique<QuadSweeps<Planar, PlanarTree>>(
        mechanism, build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  return std::make_unique<QuadSweeps<Spatial, LinkTree>>(
      mechanism, build_spatial_model(tree, mechanism.scene()));
}

}  // namespace momenta
