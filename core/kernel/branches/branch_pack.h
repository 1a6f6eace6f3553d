#pragma once
// Branches of one shape in the lanes of S, for both recursions: constants, sines and cosines,
// exchange with the remaining tree.

#include <momenta/core/kernel/branches/branch_link.h>
#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/kernel/revolute.h>

namespace momenta {

/// Constants of a revolute joint at the leaf of every branch: Leaf.
template <class S>
struct BranchLeaf {
  S inverse;
  RevoluteColumn<S> h;
  Reduced<S> M;
};

template <class S>
class BranchPack {
 public:
  static constexpr int lanes = static_cast<int>(sizeof(S) / sizeof(double));

  BranchPack(const LinkTree& tree, const BranchGroup& group)
      : group_(&group),
        links_(group.places.size()),
        leaves_(group.places.size()),
        q_(group.places.size()),
        sine_(group.places.size()),
        cosine_(group.places.size()) {
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const BranchGroup::Place& place = group.places[k];
      BranchLink<S>& l = links_[k];
      l.turn = place.turn;
      l.root = place.parent < 0;
      l.first = place.first;
      l.leaf = place.leaf;
      l.opens = place.opens;
      l.screwed = place.screwed;
      l.has_force = place.has_force;
      l.is_curved = place.is_curved;
      l.has_rotor = place.has_rotor;
      l.edge.about_z = l.screwed;
      l.edge.about_x = true;
      l.edge.about_y = l.turn == Turn::tilted;
      l.slot = place.slot;
      l.parent_slot = l.root ? -1 : group.places[static_cast<std::size_t>(place.parent)].slot;
      for (int lane = 0; lane < lanes; ++lane) {
        const auto at = static_cast<std::size_t>(link(k, lane));
        l.take(tree.links[at], tree.model->bodies[at], tree.theta0[at], lane);
      }
      if (!l.leaf) continue;
      Full<S> M;
      set_body(M, l);
      leaves_[k].inverse = S(1.0) / (M.Izz + l.rotor);
      eliminate_revolute(M, leaves_[k].inverse, leaves_[k].h, leaves_[k].M);
    }
  }

  std::size_t size() const { return links_.size(); }
  int slots() const { return group_->slots; }
  const BranchLink<S>& operator[](std::size_t k) const { return links_[k]; }
  const BranchLeaf<S>& leaf(std::size_t k) const { return leaves_[k]; }
  const S& q(std::size_t k) const { return q_[k]; }
  const S& sine(std::size_t k) const { return sine_[k]; }
  const S& cosine(std::size_t k) const { return cosine_[k]; }

  void place(const double* q) {
    gather(q, group_->q.data(), q_);
    for (std::size_t k = 0; k < links_.size(); ++k)
      sine_cosine(q_[k] + links_[k].theta0, sine_[k], cosine_[k]);
  }
  /// Numbers by u of the tree to numbers by place, and back.
  void take_rates(const double* u, std::vector<S>& to) const { gather(u, group_->u.data(), to); }
  void give_rates(const std::vector<S>& from, double* u) const {
    const auto* at = reinterpret_cast<const char*>(from.data());
    const int* index = group_->u.data();
    const int count = group_->count;
    for (std::size_t k = links_.size(); k > 0; --k, index += lanes, at += sizeof(S))
      for (int lane = 0; lane < count; ++lane) __builtin_memcpy(u + index[lane], at + 8 * lane, 8);
  }

  /// Adds the shares of the roots to the slots of the remaining tree.
  template <bool Gravity, class RemainingTree>
  void leave_at_remaining_tree(const Articulated<S>& articulated,
                               RemainingTree& remaining_tree) const {
    if (group_->one_parent) {
      const int count = group_->count, slot = group_->remaining_tree_slots.front();
      if (slot < 0) return;
      const auto sum = [count](const S& x) {
        double all = lane_of(x, 0);
        for (int lane = 1; lane < count; ++lane) all += lane_of(x, lane);
        return all;
      };
      if (group_->opens.front())
        in_pairs<Gravity>(remaining_tree.carried(slot), articulated,
                          [&](auto& a, const S& b) { a = sum(b); });
      else
        in_pairs<Gravity>(remaining_tree.carried(slot), articulated,
                          [&](auto& a, const S& b) { a = a + sum(b); });
      return;
    }
    for (int lane = 0; lane < group_->count; ++lane) {
      const int slot = group_->remaining_tree_slots[static_cast<std::size_t>(lane)];
      if (slot < 0) continue;
      if (group_->opens[static_cast<std::size_t>(lane)])
        in_pairs<Gravity>(remaining_tree.carried(slot), articulated,
                          [lane](auto& a, const S& b) { a = lane_of(b, lane); });
      else
        in_pairs<Gravity>(remaining_tree.carried(slot), articulated,
                          [lane](auto& a, const S& b) { a = a + lane_of(b, lane); });
    }
  }
  /// Motions of the roots' parents, from the remaining tree or `ground`.
  template <class RemainingTree, class One>
  void take_from_remaining_tree(const RemainingTree& remaining_tree,
                                const OutwardMotion<One>& ground, OutwardMotion<S>& motion) const {
    auto* to = reinterpret_cast<char*>(&motion);
    constexpr int numbers = sizeof(OutwardMotion<One>) / sizeof(double);
    for (int lane = 0; lane < lanes; ++lane) {
      const int slot = group_->remaining_tree_slots[static_cast<std::size_t>(
          lane < group_->count ? lane : group_->count - 1)];
      const OutwardMotion<One>& from = slot < 0 ? ground : remaining_tree.motion(slot);
      for (int i = 0; i < numbers; ++i)
        __builtin_memcpy(to + 8 * (i * lanes + lane), reinterpret_cast<const char*>(&from) + 8 * i,
                         8);
    }
  }

  /// Link, in the tree, of the first lane where x is not positive.
  int singular_joint_at(std::size_t k, const S& x) const {
    int lane = 0;
    while (lane < lanes - 1 && x.lane(lane) > 0) ++lane;
    return link(k, lane);
  }

 private:
  /// Reads memory: a lane chosen at run time does not come out of a register.
  static MOMENTA_INLINE double lane_of(const S& x, int lane) {
    double value;
    __builtin_memcpy(&value, reinterpret_cast<const char*>(&x) + 8 * lane, 8);
    return value;
  }

  int link(std::size_t k, int lane) const {
    return group_->links[k * lanes + static_cast<std::size_t>(lane)];
  }
  static void gather(const double* from, const int* i, std::vector<S>& to) {
    auto* at = reinterpret_cast<char*>(to.data());
    for (std::size_t k = to.size(); k > 0; --k, i += lanes, at += sizeof(S))
      for (int lane = 0; lane < lanes; ++lane) __builtin_memcpy(at + 8 * lane, from + i[lane], 8);
  }

  const BranchGroup* group_;
  std::vector<BranchLink<S>> links_;
  std::vector<BranchLeaf<S>> leaves_;
  std::vector<S> q_, sine_, cosine_;
};

}  // namespace momenta
