#pragma once
// The articulated-body recursion on limbs side by side: the steps of acceleration_sweeps.h for
// pins, a limb in each lane.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/limbs/limb_pack.h>

namespace momenta {

template <class S>
class LimbAccelerations {
 public:
  LimbAccelerations(const LinkTree& tree, const LimbGroup& group)
      : limbs_(tree, group),
        pins_(limbs_.size()),
        slots_(static_cast<std::size_t>(limbs_.slots())),
        outward_slots_(slots_.size()),
        u_(limbs_.size()),
        tau_(limbs_.size()),
        udot_(limbs_.size()) {}

  /// Ω and c from those of the trunk, then M*, D into its slots. False as LimbMomenta::inward.
  template <class Trunk, class One>
  bool inward(const double* q, const double* u, const double* tau, const OutwardCargo<One>& ground,
              Trunk& trunk) {
    limbs_.place(q);
    limbs_.take_rates(u, u_);
    limbs_.take_rates(tau, tau_);
    limbs_.take_from_trunk(trunk, ground, from_trunk_);
    velocities();
    if (!sweep_inward()) return false;
    limbs_.template leave_at_trunk<false>(at_trunk_, trunk);
    return true;
  }
  /// u̇ of the limbs; `ground`: accelerated against gravity.
  template <class Trunk, class One>
  void outward(const Trunk& trunk, const OutwardCargo<One>& ground, double* udot) {
    limbs_.take_from_trunk(trunk, ground, from_trunk_);
    sweep_outward();
    limbs_.give_rates(udot_, udot);
  }
  int stuck() const { return stuck_; }

 private:
  __attribute__((noinline)) void velocities();
  __attribute__((noinline)) bool sweep_inward();
  __attribute__((noinline)) void sweep_outward();

  LimbPack<S> limbs_;
  std::vector<PinAcceleration<S>> pins_;
  std::vector<Cargo<S>> slots_;
  std::vector<OutwardCargo<S>> outward_slots_;
  std::vector<S> u_, tau_, udot_;
  Cargo<S> at_trunk_;
  OutwardCargo<S> from_trunk_;
  int stuck_ = -1;
};

template <class S>
void LimbAccelerations<S>::velocities() {
  S ox = from_trunk_.ox, oy = from_trunk_.oy, oz = from_trunk_.oz;
  for (std::size_t k = 0; k < limbs_.size(); ++k) {
    const LimbLink<S>& l = limbs_[k];
    PinAcceleration<S>& w = pins_[k];
    if (!l.first && !l.root) {
      const OutwardCargo<S>& from = outward_slots_[static_cast<std::size_t>(l.parent_slot)];
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
    }
    if (l.screwed || l.turn == Turn::tilted)
      screwed_pin_velocity(l, l.edge, u_[k], limbs_.cosine(k), limbs_.sine(k), ox, oy, oz, w);
    else
      pin_velocity(l, l.edge, u_[k], limbs_.cosine(k), limbs_.sine(k), ox, oy, oz, w);
    bias_wrench(l, ox, oy, oz, w.bfx, w.bfy, w.bfz, w.bnx, w.bny, w.bnz);
    if (l.slot < 0) continue;
    OutwardCargo<S>& to = outward_slots_[static_cast<std::size_t>(l.slot)];
    to.ox = ox;
    to.oy = oy;
    to.oz = oz;
  }
}

template <class S>
bool LimbAccelerations<S>::sweep_inward() {
  Cargo<S> cargo{};
  for (std::size_t k = limbs_.size(); k-- > 0;) {
    const LimbLink<S>& l = limbs_[k];
    PinAcceleration<S>& w = pins_[k];
    Eliminated<S> r;
    PinColumn<S> h;
    S inverse;
    if (l.tip) {
      const LimbTip<S>& tip = limbs_.tip(k);
      set_bias(cargo, w);
      h = tip.h;
      r.M = tip.M;
      inverse = tip.inverse;
    } else {
      add_body(cargo.M, l);
      add_bias(cargo, w);
      if (l.slot >= 0) add<false>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
      if (!all_positive(cargo.M.Izz)) {
        stuck_ = limbs_.stuck_at(k, cargo.M.Izz);
        return false;
      }
      inverse = S(1.0) / cargo.M.Izz;
      eliminate_pin(cargo.M, inverse, h, r.M);
    }
    w.h = h;
    eliminate_bias(cargo, tau_[k], inverse, w, r);
    turn_pin(r, limbs_.cosine(k), limbs_.sine(k), l.d, w);
    carry_any<false>(l, l.edge, r, cargo);
    if (!l.first && !l.root)
      leave<false>(l, slots_[static_cast<std::size_t>(l.parent_slot)], cargo);
  }
  in_pairs<false>(at_trunk_, cargo, [](S& a, const S& b) { a = b; });
  return true;
}

template <class S>
void LimbAccelerations<S>::sweep_outward() {
  OutwardCargo<S> at = from_trunk_;
  for (std::size_t k = 0; k < limbs_.size(); ++k) {
    const LimbLink<S>& l = limbs_[k];
    if (!l.first && !l.root) at = outward_slots_[static_cast<std::size_t>(l.parent_slot)];
    S wz;
    accelerate_pin(l, l.edge, pins_[k], limbs_.cosine(k), limbs_.sine(k), at.vx, at.vy, at.vz,
                   at.ox, at.oy, at.oz, wz);
    udot_[k] = wz - at.oz;
    at.oz = wz;
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = at;
  }
}

/// The whole tree, one state: limbs in the lanes of S, the trunk in One.
template <class S, class One>
class LimbedAccelerations {
 public:
  LimbedAccelerations(const LinkTree& tree, const Limbs& limbs)
      : tree_(&tree), limbs_(&limbs), trunk_(limbs.trunk) {
    for (const LimbGroup& group : limbs.groups) groups_.emplace_back(tree, group);
  }

  /// As AccelerationSweeps<Spatial, One>.
  template <class In, class Out>
  bool operator()(double t, const In& q, const In& u, const In& tau, Out udot) {
    stuck_ = tree_->stuck;
    if (stuck_ >= 0) return false;
    const One zero(0.0);
    const auto& g = tree_->model->gravity;
    OutwardCargo<One> ground{zero, zero, zero, zero, zero, zero, zero, zero, zero};
    trunk_.place(One(t), q);
    trunk_.velocities(u);
    for (LimbAccelerations<S>& limbs : groups_)
      if (!limbs.inward(q.base, u.base, tau.base, ground, trunk_)) {
        stuck_ = limbs.stuck();
        return false;
      }
    if (!trunk_.inward(tau)) {
      stuck_ = limbs_->bodies[static_cast<std::size_t>(trunk_.stuck())];
      return false;
    }
    trunk_.outward(udot);
    ground.vx = One(-g[0]);
    ground.vy = One(-g[1]);
    ground.vz = One(-g[2]);
    for (LimbAccelerations<S>& limbs : groups_) limbs.outward(trunk_, ground, udot.base);
    return true;
  }
  int stuck() const { return stuck_; }

 private:
  const LinkTree* tree_;
  const Limbs* limbs_;
  AccelerationSweeps<Spatial, One> trunk_;
  std::vector<LimbAccelerations<S>> groups_;
  int stuck_ = -1;
};

}  // namespace momenta
