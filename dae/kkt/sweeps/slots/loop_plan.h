#pragma once
// How the sweeps carry loops: which slots a loop's equations keep, at which bodies its ends enter,
// and where it closes: at the lowest common ancestor of its two bodies.
//
// A coupler has no ends. It is open where its joints are eliminated and above, and closes once all
// of them are: at the lowest common ancestor of their parents.
//
// The fronts of a body's children are gathered one after the other, last child first; the first
// child's own goes on as the body's. What a loop asks for at the body that closes it, r = CᵀΩ − W σ
// + d, is complete as soon as its last end has come: what other children bring later has no share
// in its C, d and row of W, and is added. So it may close there, before they come, and its slots
// are free for theirs. Roots are gathered at the ground likewise, where C no longer matters; a loop
// between them is open there from the later root to the earlier one.
//
// Two loops that are open in one front need different slots: greedy colouring of the fronts, the
// loops that close nearest to the ground first.
//
// A branch may be folded: a root's subtree that all its open loops tie to one other body L. With
// the branch's own W the loops close into L at once, M*_L += J W⁻¹ Jᵀ, so that the slots of all
// branches of a platform are the same. It needs a W that is regular by itself, in every pose: only
// where slots would run out, and watched.
//
// Poses are wanted of the bodies below the one that closes a loop alone, in its axes: what a loop
// asks for is the same seen from there, and its wrenches end there (relative_ways.h).

#include <momenta/core/kernel/relative_ways.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace momenta {

/// The width of the fronts that hold `slots` slots: each is computed whole.
constexpr int lanes_for(int slots, bool planar) {
  return planar && slots <= 2 ? 2 : slots <= 4 ? 4 : slots <= 8 ? 8 : 16;
}

struct LoopPlan {
  static constexpr int most_slots = 16;

  struct End {
    int loop = 0;
    bool on_a = true;   ///< body A of the loop, the one whose wrench acts as written
    bool first = true;  ///< the end that brings the loop's right-hand side along
  };
  struct Coupling {
    int loop = 0;
    double ratio = 0;
    bool first = true;
  };
  struct Range {
    int first = 0, last = 0;  ///< [first, last)
  };

  std::vector<End> ends;                ///< by body
  std::vector<Range> ends_of;           ///< per body, into ends
  std::vector<Range> own_ends_of;       ///< ends that enter the body's own front
  std::vector<Range> gathered_ends_of;  ///< per body: those on its parent that wait for it
  std::vector<Coupling> couplings;      ///< by body, of its joint
  std::vector<Range> couplings_of;      ///< per body, into couplings
  std::vector<int> closings;            ///< loops, by where they close, in closing order
  std::vector<Range> closings_of;       ///< per body, into closings: in its own front
  /// Per body, a root or not the first child: those that close where its front has been gathered
  /// with its later siblings'.
  std::vector<Range> gathered_closings_of;
  std::vector<int> slot;         ///< per loop: its first slot
  std::vector<char> pair;        ///< per loop: rows of its point along axes 1 and 2, and no other
  std::vector<int> folded_onto;  ///< per body: of a root, the body its branch folds into; or −1
  std::vector<char> takes_branches;  ///< per body: branches fold into it
  std::vector<OnWay> posed;          ///< per body: on the way of a loop below where it closes
  int slots = 0;                     ///< slots needed
  std::int64_t work = 0;             ///< Σ over the fronts of the squared number of open equations
  bool couples() const { return !couplings.empty(); }
  /// Couplers with powers, higher pairs and equations are not carried: then all else is empty.
  bool fits() const { return slots <= most_slots && linear; }
  bool linear = true;
};

/// A loop's bodies (−1: ground) and how many equations it has; of a coupler the bodies whose joints
/// it ties, and their ratios.
struct LoopShape {
  int a = -1, b = -1, rows = 0;
  bool pair = false;
  std::vector<std::pair<int, double>> joints{};
};

/// `parents` in depth-first order, −1 for roots. O(bodies + length of all loops). With `may_gather`
/// loops close where children are gathered if that takes fewer lanes, else in the bodies' own
/// fronts, which stay in registers; with `may_fold` branches are folded where slots run out.
/// `slots` may still exceed most_slots.
LoopPlan plan_loops(const std::vector<int>& parents, const std::vector<LoopShape>& loops,
                    bool may_fold, bool may_gather);
/// The plan with every branch folded that can be.
LoopPlan plan_folded(const std::vector<int>& parents, const std::vector<LoopShape>& loops);

}  // namespace momenta
