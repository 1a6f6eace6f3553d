#pragma once
// Branches side by side beside the sweeps of the rest: numbers of one state into the lanes of S and
// back, and what branches and the body they fold into hand to each other.

#include <momenta/dae/kkt/sweeps/branches/looped_branch_tree.h>
#include <momenta/dae/kkt/sweeps/slots/right_side.h>
#include <momenta/dae/kkt/sweeps/slots/slots.h>
#include <momenta/dae/kkt/sweeps/slots/spatial_loop_place.h>

namespace momenta {

template <class S, int Rows, bool Momentum, class Tree>
class SpatialLoopSweeps;

/// Scalar of branches beside a single state's S; void: none.
template <class S>
struct LoopedBranchLanes {
  using type = void;
};
template <int L>
struct LoopedBranchLanes<Pack<1, L>> {
  using type = Pack<looped_branch_lanes_at(L), L>;
};

/// A pack of branches. One: a single state's number; S: a pack of them at the same level.
template <class One, class S, bool Momentum>
class LoopedBranchPack {
  using Sweeps = SpatialLoopSweeps<S, most_looped_branch_rows, Momentum, LoopedBranchTree<S>>;
  using Motion = Spatial::Motion<One>;

 public:
  /// @pre the group stays where it is
  LoopedBranchPack(const LinkTree& tree, const LoopModel<Spatial>& loops,
                   const LoopedBranchGroup& group)
      : group_(group),
        tree_(tree, group),
        loops_(loops, group),
        sweeps_(tree_, loops_, group.plan) {
    for (int lane = 0; lane < lanes; ++lane) used_.set_lane(lane, lane < group.count);
    for (int k = 0; k < group.bodies; ++k)
      for (const int root : group.roots) {
        const Link& l = tree.links[static_cast<std::size_t>(root + k)];
        const auto& b = tree.model->bodies[static_cast<std::size_t>(root + k)];
        q_at_.push_back(b.q);
        u_at_.push_back(l.kind == LinkKind::revolute ? l.u : b.u);
      }
    for (int i = 0; i < group.loops; ++i) {
      const auto row_of = [&](int lane) {
        return loops
            .loops[static_cast<std::size_t>(group.loop[static_cast<std::size_t>(i * lanes + lane)])]
            .row;
      };
      for (int row = 0; row < loops_.loops[static_cast<std::size_t>(i)].rows; ++row)
        for (int lane = 0; lane < lanes; ++lane) row_at_.push_back(row_of(lane) + row);
    }
    for (auto* x : {&q_, &x_, &tau_, &u_, &rate_})
      x->resize(static_cast<std::size_t>(group.bodies));
    for (auto* x : {&sigma_, &centre_, &compliance_})
      x->resize(static_cast<std::size_t>(loops_.rows));
  }
  // Not copied: its sweeps point to its tree.
  LoopedBranchPack(const LoopedBranchPack&) = delete;
  LoopedBranchPack& operator=(const LoopedBranchPack&) = delete;

  int onto() const { return group_.onto; }

  /// Adds the branches' share to the body in the place and motion of `onto`. False when a joint has
  /// no inertia to move, or branches need different orders of elimination.
  template <class In>
  bool inward(const One& t, const In& q, const In& x, const In& tau, const RightSide<One>& right,
              const LoopBody<One>& onto, Articulated<One>& sum) {
    gather(q, q_at_, q_);
    gather(x, u_at_, x_);
    if constexpr (!Momentum) gather(tau, u_at_, tau_);
    right_ = right.template of_rows<S>(gathered(right.centre, centre_),
                                       gathered(right.compliance, compliance_));
    LoopBody<S> body;
    all_of(onto.pose.axes, body.pose.axes);
    all_of(onto.pose.origin, body.pose.origin);
    if constexpr (!Momentum) {
      all_of(onto.v, body.v);
      all_of(onto.w, body.w);
    }
    const S *at = q_.data(), *in = x_.data(), *forces = tau_.data();
    if (!sweeps_.looped_branches_inward(S(t.v), at, in, forces, right_, body) || sweeps_.uneven())
      return false;
    const S used = used_;
    in_pairs<Momentum>(sum, sweeps_.brought_by_looped_branches(),
                       [used](One& a, const S& b) { a = a + sum_of(b * used); });
    return true;
  }
  bool weak_looped_branch() const { return sweeps_.weak_looped_branch(); }

  /// u or u̇ and the impulses of the branches from the motion V of the body, in its axes.
  template <class Out>
  void outward(const Motion& V, Out u, Out impulse) {
    Spatial::Motion<S> all;
    all_of(V.v, all.v);
    all_of(V.w, all.w);
    const S* at = q_.data();
    sweeps_.looped_branches_outward(at, right_, all, u_.data(), sigma_.data(), rate_.data());
    scatter(u_, u_at_, u);
    scatter(sigma_, row_at_, impulse);
  }
  /// The whole ṗ of the branches; adds to `wrench` what their loops do to the body, whose
  /// velocities are in `onto`; ground axes.
  template <class Out>
  void inertial_rates(const LoopBody<One>& onto, Spatial::Force<One>& wrench, Out rate) {
    Vec3<S> v, w;
    all_of(onto.v, v);
    all_of(onto.w, w);
    const Spatial::Force<S>& T =
        sweeps_.looped_branches_rates(v, w, right_, sigma_.data(), rate_.data());
    for (int i = 0; i < 6; ++i) wrench[i] = wrench[i] + sum_of(T[i] * used_);
    scatter(rate_, u_at_, rate);
  }

  /// report(row of Φ, w, τ) for all pivots.
  template <class Report>
  void each_pivot(Report&& report) const {
    sweeps_.each_row([&](int row, const S& w, const S& tau) {
      for (int lane = 0; lane < group_.count; ++lane)
        report(row_at_[static_cast<std::size_t>(row * lanes + lane)], w.lane(lane), tau.lane(lane));
    });
  }

 private:
  static constexpr int lanes = static_cast<int>(sizeof(S) / sizeof(double));

  static void all_of(const Vec3<One>& x, Vec3<S>& to) {
    for (int i = 0; i < 3; ++i) to[i] = S(x[i].v);
  }
  static void all_of(const Mat3<One>& x, Mat3<S>& to) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) to(i, j) = S(x(i, j).v);
  }
  template <class In>
  static void gather(const In& from, const std::vector<int>& index, std::vector<S>& to) {
    // Made in a register: a pack read back from eight writes waits for all of them.
    const int* at = index.data();
    for (S& x : to) {
      each<lanes>([&](auto place) MOMENTA_INLINED {
        constexpr int lane = place;
        x.v[lane] = from[at[lane]].v;
      });
      at += lanes;
    }
  }
  template <class Out>
  void scatter(const std::vector<S>& from, const std::vector<int>& index, Out& to) const {
    const auto* at = reinterpret_cast<const char*>(from.data());
    for (std::size_t i = 0; i < index.size(); i += static_cast<std::size_t>(lanes))
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(group_.count); ++lane) {
        One x;
        __builtin_memcpy(&x, at + sizeof(double) * (i + lane), sizeof(double));
        to[index[i + lane]] = x;
      }
  }
  const S* gathered(const One* from, std::vector<S>& to) const {
    if (!from) return nullptr;
    gather(from, row_at_, to);
    return to.data();
  }

  const LoopedBranchGroup& group_;
  LoopedBranchTree<S> tree_;
  LoopedBranchLoops<S> loops_;
  Sweeps sweeps_;
  std::vector<int> q_at_, u_at_, row_at_;  ///< by place and lane
  std::vector<S> q_, x_, tau_, u_, rate_, sigma_, centre_, compliance_;
  RightSide<S> right_;
  S used_{};  ///< 1 in the lanes in use, 0 in the others
};

}  // namespace momenta
