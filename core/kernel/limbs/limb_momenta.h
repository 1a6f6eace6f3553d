#pragma once
// The momentum recursion on limbs side by side: the steps of momentum_sweeps.h and momentum_pins.h
// for pins, a limb in each lane.

#include <momenta/core/kernel/limbs/limb_pack.h>
#include <momenta/core/kernel/momentum_sweeps.h>

namespace momenta {

template <class S>
class LimbMomenta {
 public:
  LimbMomenta(const LinkTree& tree, const LimbGroup& group)
      : limbs_(tree, group),
        pins_(limbs_.size()),
        slots_(static_cast<std::size_t>(limbs_.slots())),
        outward_slots_(slots_.size()),
        p_(limbs_.size()),
        u_(limbs_.size()),
        pdot_(limbs_.size()) {}

  /// From (q, p) of the whole tree to M*, D, G in the trunk's slots. False when a joint has no
  /// inertia to move: stuck(), a link of the tree.
  template <bool Gravity, class Trunk>
  bool inward(const double* q, const double* p, Trunk& trunk) {
    limbs_.place(q);
    limbs_.take_rates(p, p_);
    if (!sweep_inward<Gravity>()) return false;
    limbs_.template leave_at_trunk<Gravity>(at_trunk_, trunk);
    return true;
  }
  /// u, ṗ of the limbs; `ground`: at rest, with gravity.
  template <bool Gravity, class Trunk, class One>
  void outward(const Trunk& trunk, const OutwardCargo<One>& ground, double* u, double* pdot) {
    limbs_.take_from_trunk(trunk, ground, from_trunk_);
    sweep_outward<Gravity>();
    limbs_.give_rates(u_, u);
    limbs_.give_rates(pdot_, pdot);
  }
  int stuck() const { return stuck_; }

 private:
  template <bool Gravity>
  __attribute__((noinline)) bool sweep_inward();
  template <bool Gravity>
  __attribute__((noinline)) void sweep_outward();

  LimbPack<S> limbs_;
  std::vector<PinRecord<S>> pins_;
  std::vector<Cargo<S>> slots_;
  std::vector<OutwardCargo<S>> outward_slots_;
  std::vector<S> p_, u_, pdot_;
  Cargo<S> at_trunk_;
  OutwardCargo<S> from_trunk_;
  int stuck_ = -1;
};

template <class S>
template <bool Gravity>
bool LimbMomenta<S>::sweep_inward() {
  Cargo<S> cargo{};
  for (std::size_t k = limbs_.size(); k-- > 0;) {
    const LimbLink<S>& l = limbs_[k];
    PinRecord<S>& w = pins_[k];
    Eliminated<S> r;
    if (l.tip) {
      const LimbTip<S>& tip = limbs_.tip(k);
      leave_tip<Gravity>(tip.h, tip.M, tip.inverse, l.moment, p_[k], w, r);
    } else {
      add_body<Gravity>(cargo, l);
      if (l.slot >= 0) add<Gravity>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
      if (!all_positive(cargo.M.Izz)) {
        stuck_ = limbs_.stuck_at(k, cargo.M.Izz);
        return false;
      }
      eliminate_pin<Gravity>(cargo, p_[k], S(1.0) / cargo.M.Izz, w, r);
    }
    turn_pin<Gravity>(r, limbs_.cosine(k), limbs_.sine(k), l.d, w);
    carry_any<Gravity>(l, l.edge, r, cargo);
    if (!l.first && !l.root)
      leave<Gravity>(l, slots_[static_cast<std::size_t>(l.parent_slot)], cargo);
  }
  in_pairs<Gravity>(at_trunk_, cargo, [](S& a, const S& b) { a = b; });
  return true;
}

template <class S>
template <bool Gravity>
void LimbMomenta<S>::sweep_outward() {
  OutwardCargo<S> at = from_trunk_;
  for (std::size_t k = 0; k < limbs_.size(); ++k) {
    const LimbLink<S>& l = limbs_[k];
    if (!l.first && !l.root) at = outward_slots_[static_cast<std::size_t>(l.parent_slot)];
    S wz, rate;
    move_pin<Gravity>(l, l.edge, pins_[k], limbs_.cosine(k), limbs_.sine(k), at.vx, at.vy, at.vz,
                      at.ox, at.oy, at.oz, at.gx, at.gy, at.gz, wz, rate);
    const S own = wz - at.oz;
    at.oz = wz;
    if (l.has_force) rate = rate + joint_force(l, limbs_.q(k), own);
    u_[k] = own;
    pdot_[k] = rate;
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = at;
  }
}

/// The whole tree, one state: limbs in the lanes of S, the trunk in One.
template <class S, class One>
class LimbedMomenta {
 public:
  LimbedMomenta(const LinkTree& tree, const Limbs& limbs)
      : tree_(&tree), limbs_(&limbs), trunk_(limbs.trunk) {
    for (const LimbGroup& group : limbs.groups) groups_.emplace_back(tree, group);
  }

  /// As MomentumSweeps<Spatial, One>.
  template <class In, class Out>
  bool operator()(double t, const In& q, const In& p, Out u, Out pdot) {
    return tree_->model->has_gravity ? evaluate<true>(t, q, p, u, pdot)
                                     : evaluate<false>(t, q, p, u, pdot);
  }
  int stuck() const { return stuck_; }

 private:
  template <bool Gravity, class In, class Out>
  bool evaluate(double t, const In& q, const In& p, Out u, Out pdot) {
    stuck_ = tree_->stuck;
    if (stuck_ >= 0) return false;
    for (LimbMomenta<S>& limbs : groups_)
      if (!limbs.template inward<Gravity>(q.base, p.base, trunk_)) {
        stuck_ = limbs.stuck();
        return false;
      }
    if (!trunk_(One(t), q, p, u, pdot)) {
      stuck_ = limbs_->bodies[static_cast<std::size_t>(trunk_.stuck())];
      return false;
    }
    const auto& g = tree_->model->gravity;
    const One zero(0.0);
    const OutwardCargo<One> ground{zero, zero,      zero,      zero,     zero,
                                   zero, One(g[0]), One(g[1]), One(g[2])};
    for (LimbMomenta<S>& limbs : groups_)
      limbs.template outward<Gravity>(trunk_, ground, u.base, pdot.base);
    return true;
  }

  const LinkTree* tree_;
  const Limbs* limbs_;
  MomentumSweeps<Spatial, One> trunk_;
  std::vector<LimbMomenta<S>> groups_;
  int stuck_ = -1;
};

}  // namespace momenta
