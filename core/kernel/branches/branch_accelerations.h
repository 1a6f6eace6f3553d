#pragma once
// The articulated-body recursion for revolute joints on branches side by side, a branch in each
// lane: acceleration_sweeps.h.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/branches/branch_pack.h>

namespace momenta {

template <class S>
class BranchAccelerations {
 public:
  BranchAccelerations(const LinkTree& tree, const BranchGroup& group)
      : branches_(tree, group),
        revolutes_(branches_.size()),
        slots_(static_cast<std::size_t>(branches_.slots())),
        outward_slots_(slots_.size()),
        u_(branches_.size()),
        tau_(branches_.size()),
        udot_(branches_.size()) {}

  /// Takes Ω and c from the remaining tree, then leaves M*, D in its slots. False as for
  /// BranchMomenta::inward.
  template <class RemainingTree, class One>
  bool inward(const double* q, const double* u, const double* tau, const OutwardMotion<One>& ground,
              RemainingTree& remaining_tree) {
    branches_.place(q);
    branches_.take_rates(u, u_);
    branches_.take_rates(tau, tau_);
    branches_.take_from_remaining_tree(remaining_tree, ground, from_remaining_tree_);
    velocities();
    if (!sweep_inward()) return false;
    branches_.template leave_at_remaining_tree<false>(at_remaining_tree_, remaining_tree);
    return true;
  }
  /// u̇ of the branches; `ground`: its acceleration against gravity.
  template <class RemainingTree, class One>
  void outward(const RemainingTree& remaining_tree, const OutwardMotion<One>& ground,
               double* udot) {
    branches_.take_from_remaining_tree(remaining_tree, ground, from_remaining_tree_);
    sweep_outward();
    branches_.give_rates(udot_, udot);
  }
  int singular_joint() const { return singular_joint_; }

 private:
  __attribute__((noinline)) void velocities();
  __attribute__((noinline)) bool sweep_inward();
  __attribute__((noinline)) void sweep_outward();

  BranchPack<S> branches_;
  std::vector<RevoluteAcceleration<S>> revolutes_;
  std::vector<Articulated<S>> slots_;
  std::vector<OutwardMotion<S>> outward_slots_;
  std::vector<S> u_, tau_, udot_;
  Articulated<S> at_remaining_tree_;
  OutwardMotion<S> from_remaining_tree_;
  int singular_joint_ = -1;
};

template <class S>
void BranchAccelerations<S>::velocities() {
  S ox = from_remaining_tree_.ox, oy = from_remaining_tree_.oy, oz = from_remaining_tree_.oz;
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    const BranchLink<S>& l = branches_[k];
    RevoluteAcceleration<S>& w = revolutes_[k];
    if (!l.first && !l.root) {
      const OutwardMotion<S>& from = outward_slots_[static_cast<std::size_t>(l.parent_slot)];
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
    }
    if (l.screwed || l.turn == Turn::tilted)
      screwed_revolute_velocity(l, l.edge, u_[k], branches_.cosine(k), branches_.sine(k), ox, oy,
                                oz, w);
    else
      revolute_velocity(l, l.edge, u_[k], branches_.cosine(k), branches_.sine(k), ox, oy, oz, w);
    bias_wrench(l, ox, oy, oz, w.bfx, w.bfy, w.bfz, w.bnx, w.bny, w.bnz);
    if (l.slot < 0) continue;
    OutwardMotion<S>& to = outward_slots_[static_cast<std::size_t>(l.slot)];
    to.ox = ox;
    to.oy = oy;
    to.oz = oz;
  }
}

template <class S>
bool BranchAccelerations<S>::sweep_inward() {
  Articulated<S> articulated{};
  for (std::size_t k = branches_.size(); k-- > 0;) {
    const BranchLink<S>& l = branches_[k];
    RevoluteAcceleration<S>& w = revolutes_[k];
    Eliminated<S> r;
    RevoluteColumn<S> h;
    S inverse;
    if (l.leaf) {
      const BranchLeaf<S>& leaf = branches_.leaf(k);
      set_bias(articulated, w);
      h = leaf.h;
      r.M = leaf.M;
      inverse = leaf.inverse;
    } else {
      add_body(articulated.M, l);
      add_bias(articulated, w);
      if (l.slot >= 0) add<false>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
      const S pivot = pivot_of(l, articulated.M.Izz);
      if (!all_positive(pivot)) {
        singular_joint_ = branches_.singular_joint_at(k, pivot);
        return false;
      }
      inverse = S(1.0) / pivot;
      eliminate_revolute(articulated.M, inverse, h, r.M);
    }
    w.h = h;
    eliminate_bias(articulated, tau_[k], inverse, w, r);
    const S c = branches_.cosine(k), s = branches_.sine(k);
    turn_revolute(r, c, s, l.d, w);
    Spatial::Force<S> column;
    if (l.has_rotor) [[unlikely]] {
      w.inverse = inverse;
      column = turned_rotor(l, h, inverse, c, s);
      r.nz = tau_[k] - l.rotor * w.y0 + rotor_bias(column, w);
    }
    carry_any<false>(l, l.edge, r, articulated);
    if (l.has_rotor) [[unlikely]]
      hand_on_rotor(l.edge, column, articulated);
    if (!l.first && !l.root)
      leave<false>(l, slots_[static_cast<std::size_t>(l.parent_slot)], articulated);
  }
  in_pairs<false>(at_remaining_tree_, articulated, [](S& a, const S& b) { a = b; });
  return true;
}

template <class S>
void BranchAccelerations<S>::sweep_outward() {
  OutwardMotion<S> at = from_remaining_tree_;
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    const BranchLink<S>& l = branches_[k];
    if (!l.first && !l.root) at = outward_slots_[static_cast<std::size_t>(l.parent_slot)];
    S wz;
    accelerate_revolute(l, l.edge, revolutes_[k], branches_.cosine(k), branches_.sine(k), at.vx,
                        at.vy, at.vz, at.ox, at.oy, at.oz, wz);
    udot_[k] = wz - at.oz;
    at.oz = wz;
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = at;
  }
}

/// The whole tree, one state: branches in lanes of S, the remaining tree in One.
template <class S, class One>
class BranchedAccelerations {
 public:
  BranchedAccelerations(const LinkTree& tree, const Branches& branches)
      : tree_(&tree), branches_(&branches), remaining_tree_(branches.remaining_tree) {
    for (const BranchGroup& group : branches.groups) groups_.emplace_back(tree, group);
  }

  /// The interface of AccelerationSweeps<Spatial, One>.
  template <class In, class Out>
  bool operator()(double t, const In& q, const In& u, const In& tau, Out udot) {
    singular_joint_ = tree_->singular_joint;
    if (singular_joint_ >= 0) return false;
    const One zero(0.0);
    const auto& g = tree_->model->gravity;
    OutwardMotion<One> ground{zero, zero, zero, zero, zero, zero, zero, zero, zero};
    remaining_tree_.place(One(t), q);
    remaining_tree_.velocities(u);
    for (BranchAccelerations<S>& branches : groups_)
      if (!branches.inward(q.base, u.base, tau.base, ground, remaining_tree_)) {
        singular_joint_ = branches.singular_joint();
        return false;
      }
    if (!remaining_tree_.inward(tau)) {
      singular_joint_ =
          branches_->bodies[static_cast<std::size_t>(remaining_tree_.singular_joint())];
      return false;
    }
    remaining_tree_.outward(udot);
    ground.vx = One(-g[0]);
    ground.vy = One(-g[1]);
    ground.vz = One(-g[2]);
    for (BranchAccelerations<S>& branches : groups_)
      branches.outward(remaining_tree_, ground, udot.base);
    return true;
  }
  int singular_joint() const { return singular_joint_; }

 private:
  const LinkTree* tree_;
  const Branches* branches_;
  AccelerationSweeps<Spatial, One> remaining_tree_;
  std::vector<BranchAccelerations<S>> groups_;
  int singular_joint_ = -1;
};

}  // namespace momenta
