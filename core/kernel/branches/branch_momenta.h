#pragma once
// The momentum recursion for revolute joints on branches side by side, a branch in each lane:
// momentum_sweeps.h, momentum_revolutes.h.

#include <momenta/core/kernel/branches/branch_pack.h>
#include <momenta/core/kernel/momentum_sweeps.h>

namespace momenta {

template <class S>
class BranchMomenta {
 public:
  BranchMomenta(const LinkTree& tree, const BranchGroup& group)
      : branches_(tree, group),
        revolutes_(branches_.size()),
        slots_(static_cast<std::size_t>(branches_.slots())),
        outward_slots_(slots_.size()),
        p_(branches_.size()),
        u_(branches_.size()),
        pdot_(branches_.size()) {}

  /// Takes (q, p) of the whole tree, leaves M*, D, G in the remaining tree's slots. False when a
  /// joint has no inertia: singular_joint(), a link of the tree.
  template <bool Gravity, class RemainingTree>
  bool inward(const double* q, const double* p, RemainingTree& remaining_tree) {
    branches_.place(q);
    branches_.take_rates(p, p_);
    if (!sweep_inward<Gravity>()) return false;
    branches_.template leave_at_remaining_tree<Gravity>(at_remaining_tree_, remaining_tree);
    return true;
  }
  /// u, ṗ of the branches; `ground`: at rest, with gravity.
  template <bool Gravity, class RemainingTree, class One>
  void outward(const RemainingTree& remaining_tree, const OutwardMotion<One>& ground, double* u,
               double* pdot) {
    branches_.take_from_remaining_tree(remaining_tree, ground, from_remaining_tree_);
    sweep_outward<Gravity>();
    branches_.give_rates(u_, u);
    branches_.give_rates(pdot_, pdot);
  }
  int singular_joint() const { return singular_joint_; }

 private:
  template <bool Gravity>
  __attribute__((noinline)) bool sweep_inward();
  template <bool Gravity>
  __attribute__((noinline)) void sweep_outward();

  BranchPack<S> branches_;
  std::vector<RevoluteRecord<S>> revolutes_;
  std::vector<Articulated<S>> slots_;
  std::vector<OutwardMotion<S>> outward_slots_;
  std::vector<S> p_, u_, pdot_;
  Articulated<S> at_remaining_tree_;
  OutwardMotion<S> from_remaining_tree_;
  int singular_joint_ = -1;
};

template <class S>
template <bool Gravity>
bool BranchMomenta<S>::sweep_inward() {
  Articulated<S> articulated{};
  for (std::size_t k = branches_.size(); k-- > 0;) {
    const BranchLink<S>& l = branches_[k];
    RevoluteRecord<S>& w = revolutes_[k];
    Eliminated<S> r;
    if (l.leaf) {
      const BranchLeaf<S>& leaf = branches_.leaf(k);
      hand_on_leaf<Gravity>(leaf.h, leaf.M, leaf.inverse, l.moment, p_[k], w, r);
    } else {
      add_body<Gravity>(articulated, l);
      if (l.slot >= 0) add<Gravity>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
      const S pivot = pivot_of(l, articulated.M.Izz);
      if (!all_positive(pivot)) {
        singular_joint_ = branches_.singular_joint_at(k, pivot);
        return false;
      }
      eliminate_revolute<Gravity>(articulated, p_[k], S(1.0) / pivot, w, r);
    }
    const S c = branches_.cosine(k), s = branches_.sine(k);
    if (l.has_rotor) r.nz = p_[k] - l.rotor * w.y0;
    turn_revolute<Gravity>(r, c, s, l.d, w);
    carry_any<Gravity>(l, l.edge, r, articulated);
    if (l.has_rotor) [[unlikely]]
      hand_on_rotor(l.edge, turned_rotor(l, w.h, w.inverse, c, s), articulated);
    if (!l.first && !l.root)
      leave<Gravity>(l, slots_[static_cast<std::size_t>(l.parent_slot)], articulated);
  }
  in_pairs<Gravity>(at_remaining_tree_, articulated, [](S& a, const S& b) { a = b; });
  return true;
}

template <class S>
template <bool Gravity>
void BranchMomenta<S>::sweep_outward() {
  OutwardMotion<S> at = from_remaining_tree_;
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    const BranchLink<S>& l = branches_[k];
    if (!l.first && !l.root) at = outward_slots_[static_cast<std::size_t>(l.parent_slot)];
    S wz, rate;
    move_revolute<Gravity>(l, l.edge, revolutes_[k], branches_.cosine(k), branches_.sine(k), at.vx,
                           at.vy, at.vz, at.ox, at.oy, at.oz, at.gx, at.gy, at.gz, wz, rate);
    const S own = wz - at.oz;
    at.oz = wz;
    if (l.has_force) rate = rate + joint_force(l, branches_.q(k), own);
    u_[k] = own;
    pdot_[k] = rate;
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = at;
  }
}

/// The whole tree, one state: branches in lanes of S, the remaining tree in One.
template <class S, class One>
class BranchedMomenta {
 public:
  BranchedMomenta(const LinkTree& tree, const Branches& branches)
      : tree_(&tree), branches_(&branches), remaining_tree_(branches.remaining_tree) {
    for (const BranchGroup& group : branches.groups) groups_.emplace_back(tree, group);
  }

  /// The interface of MomentumSweeps<Spatial, One>.
  template <class In, class Out>
  bool operator()(double t, const In& q, const In& p, Out u, Out pdot) {
    return tree_->model->has_gravity ? evaluate<true>(t, q, p, u, pdot)
                                     : evaluate<false>(t, q, p, u, pdot);
  }
  int singular_joint() const { return singular_joint_; }

 private:
  template <bool Gravity, class In, class Out>
  bool evaluate(double t, const In& q, const In& p, Out u, Out pdot) {
    singular_joint_ = tree_->singular_joint;
    if (singular_joint_ >= 0) return false;
    for (BranchMomenta<S>& branches : groups_)
      if (!branches.template inward<Gravity>(q.base, p.base, remaining_tree_)) {
        singular_joint_ = branches.singular_joint();
        return false;
      }
    if (!remaining_tree_(One(t), q, p, u, pdot)) {
      singular_joint_ =
          branches_->bodies[static_cast<std::size_t>(remaining_tree_.singular_joint())];
      return false;
    }
    const auto& g = tree_->model->gravity;
    const One zero(0.0);
    const OutwardMotion<One> ground{zero, zero,      zero,      zero,     zero,
                                    zero, One(g[0]), One(g[1]), One(g[2])};
    for (BranchMomenta<S>& branches : groups_)
      branches.template outward<Gravity>(remaining_tree_, ground, u.base, pdot.base);
    return true;
  }

  const LinkTree* tree_;
  const Branches* branches_;
  MomentumSweeps<Spatial, One> remaining_tree_;
  std::vector<BranchMomenta<S>> groups_;
  int singular_joint_ = -1;
};

}  // namespace momenta
