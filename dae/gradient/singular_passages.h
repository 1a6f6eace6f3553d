#pragma once
// Times when stages of a run came near to a singular pose, once a passage: the weakest pivot of the
// loops is below a hundredth of its scale and of the largest so far. Pivots go with the square of
// the distance.

#include <momenta/dae/kkt/loop_solver.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace momenta {

class SingularPassages {
 public:
  /// A stage at t [s].
  void take(double t, const LoopSolver::Pivots& pivots) {
    always_faded_ = std::min(always_faded_, pivots.faded);
    const double weakest = pivots.faded > always_faded_ ? 0 : pivots.weakest;
    if (weakest < weakest_) weakest_at_ = t, weakest_ = weakest;
    largest_ = std::max(largest_, weakest);
  }
  /// Ends a step.
  void end_step() {
    constexpr double near = 1e-2;
    const bool near_pose = weakest_ < near && weakest_ < near * largest_;
    if (near_pose && !passing_) {
      passages_.push_back(weakest_at_);
      least_ = weakest_;
    }
    if (near_pose && weakest_ < least_) passages_.back() = weakest_at_, least_ = weakest_;
    passing_ = near_pose;
    weakest_ = 1;
  }
  /// [s]
  const std::vector<double>& times() const { return passages_; }

 private:
  int always_faded_ = std::numeric_limits<int>::max();  ///< rows redundant in all stages
  double weakest_ = 1;                                  ///< weakest pivot in the step under way
  double weakest_at_ = 0;                               ///< time of weakest_
  double least_ = 1;                                    ///< least pivot in the passage under way
  double largest_ = 0;                                  ///< largest pivot of the run
  bool passing_ = false;
  std::vector<double> passages_;
};

/// Why a run has no derivatives at a time.
inline constexpr const char* too_near_to_pose =
    "the motion passes too near to a singular pose, where its loop equations become dependent, for "
    "derivatives";
inline constexpr const char* dependent_loops =
    "the loop equations become dependent there, and the motion has no derivatives beyond such a "
    "pose";

}  // namespace momenta
